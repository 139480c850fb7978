#include "sim/scene/touching.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "kernels/index.h"
#include "kernels/parallel/parallel_for.h"
#include "sim/scene/box_tree.h"
#include "sim/scene/exact_triangles.h"

namespace icloth {
namespace {

bool has(const Triangle& face, Index v) { return v == face[0] || v == face[1] || v == face[2]; }

/// Faces around a vertex up to which all pairs of them are tested.
constexpr std::size_t kFewFaces = 32;

/// The faces around one vertex, in a tree of their opposite edges. Two faces that touch beside the
/// vertex do so with two elements of which one at most ends there, so the opposite edge of one of
/// the faces touches the other face.
class Crowd {
 public:
  Crowd(std::span<const Vec3d> positions, std::span<const Triangle> faces,
        std::span<const Index> around, Index centre)
      : around_(around), opposite_(boxes_of(positions, faces, around, centre)), tree_(opposite_) {}

  /// Calls visit_face(f) for every face whose opposite edge may touch something in the box.
  template <class Visit>
  void visit(const Box& box, const Visit& visit_face) const {
    tree_.visit(box, [&](Index i) { visit_face(around_[at(i)]); });
  }

 private:
  static std::vector<Box> boxes_of(std::span<const Vec3d> positions,
                                   std::span<const Triangle> faces, std::span<const Index> around,
                                   Index centre) {
    std::vector<Box> boxes(around.size());
    for (std::size_t i = 0; i < around.size(); ++i)
      for (const Index v : faces[at(around[i])])
        if (v != centre) boxes[i].add(positions[at(v)]);
    return boxes;
  }

  std::span<const Index> around_;
  std::vector<Box> opposite_;
  BoxTree tree_;  ///< refers to the boxes
};

/// Tests the elements of two faces that share a vertex.
class NeighbourTest {
 public:
  NeighbourTest(std::span<const Vec3d> positions, std::span<const Triangle> faces)
      : x_(positions), faces_(faces) {}

  void run(Index a, Index b, std::vector<Touch>& found) const {
    // Vertices of each face may lie on the other one.
    const std::size_t before = found.size();
    vertices_on_face(a, b, found);
    vertices_on_face(b, a, found);
    if (found.size() > before) return;

    // Edges may cross; those that meet at a vertex were found as that vertex.
    const Triangle &s = faces_[at(a)], &t = faces_[at(b)];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const Index p = s[i], q = s[(i + 1) % 3], r = t[j], u = t[(j + 1) % 3];
        if (has(t, p) && has(t, q)) continue;
        if (p == r || p == u || q == r || q == u) continue;
        if (!segments_meet(x(p), x(q), x(r), x(u))) continue;
        found.push_back({Touch::Kind::edge_edge, {p, q, r, u}, std::min(a, b), std::max(a, b)});
      }
  }

 private:
  void vertices_on_face(Index own, Index other, std::vector<Touch>& found) const {
    const Triangle& t = faces_[at(other)];
    for (const Index v : faces_[at(own)]) {
      if (has(t, v) || !point_meets(x(v), {x(t[0]), x(t[1]), x(t[2])})) continue;

      Touch touch{Touch::Kind::vertex_face,
                  {v, t[0], t[1], t[2]},
                  std::min(own, other),
                  std::max(own, other)};

      // The smallest element that holds the point says most to the reader.
      for (std::size_t k = 0; k < 3; ++k)
        if (segments_meet(x(v), x(v), x(t[k]), x(t[(k + 1) % 3])))
          touch = {Touch::Kind::vertex_edge, {v, t[k], t[(k + 1) % 3], -1}, touch.a, touch.b};
      for (const Index corner : t)
        if (x(corner) == x(v))
          touch = {Touch::Kind::vertex_vertex, {v, corner, -1, -1}, touch.a, touch.b};
      found.push_back(touch);
    }
  }

  const Vec3d& x(Index v) const { return x_[at(v)]; }

  std::span<const Vec3d> x_;
  std::span<const Triangle> faces_;
};

}  // namespace

std::vector<Touch> find_touching_neighbours(std::span<const Vec3d> positions,
                                            std::span<const Triangle> faces,
                                            std::span<const int> group) {
  // Every vertex gets a list of its faces.
  std::vector<Index> first(positions.size() + 1, 0), around(3 * faces.size());
  for (const Triangle& t : faces)
    for (const Index v : t) ++first[at(v) + 1];
  for (std::size_t v = 0; v < positions.size(); ++v) first[v + 1] += first[v];
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (const Index v : faces[f]) around[at(next[at(v)]++)] = static_cast<Index>(f);

  // A polygon that was cut as a fan has thousands of faces at one vertex, and millions of pairs.
  std::map<Index, Crowd> crowds;
  for (Index v = 0; v < static_cast<Index>(positions.size()); ++v) {
    const auto own = std::span<const Index>(around).subspan(
        at(first[at(v)]), at(first[at(v) + 1]) - at(first[at(v)]));
    const bool is_cloth = group.empty() || own.empty() || group[at(own[0])] >= 0;
    if (own.size() > kFewFaces && is_cloth) crowds.try_emplace(v, positions, faces, own, v);
  }

  // Every pair of neighbours is tested once: from its first face, at the first vertex that both
  // have. In a crowd a pair may come up twice.
  const NeighbourTest test(positions, faces);
  std::vector<Touch> found;
  std::mutex lock;  // the order of arrival is undone by the sort below
  const auto test_face = [&](Index a) {
    std::vector<Touch> own;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = faces[at(a)][k];

      // The tree of a crowd gives the faces that may touch this one.
      if (const auto crowd = crowds.find(v); crowd != crowds.end()) {
        Box box;
        for (const Index corner : faces[at(a)]) box.add(positions[at(corner)]);
        crowd->second.visit(box, [&](Index b) {
          if (b != a) test.run(std::min(a, b), std::max(a, b), own);
        });
        continue;
      }

      // Elsewhere all faces of the vertex are tested that have not been before.
      for (Index i = first[at(v)]; i < first[at(v) + 1]; ++i) {
        const Index b = around[at(i)];
        bool seen = b <= a;
        for (std::size_t before = 0; before < k; ++before)
          seen = seen || has(faces[at(b)], faces[at(a)][before]);
        if (!seen) test.run(a, b, own);
      }
    }
    if (own.empty()) return;
    const std::lock_guard guard(lock);
    found.insert(found.end(), own.begin(), own.end());
  };
  parallel_for(static_cast<Index>(faces.size()), 64, 64, [&](Index begin, Index end) {
    for (Index a = begin; a < end; ++a)
      if (group.empty() || group[at(a)] >= 0) test_face(a);
  });
  std::ranges::sort(found, {}, [](const Touch& t) { return std::pair(std::array{t.a, t.b}, t.v); });

  // The same elements may meet in several pairs of faces.
  std::set<std::pair<Touch::Kind, std::array<Index, 4>>> seen;
  std::erase_if(found, [&](const Touch& t) {
    auto key = std::pair(t.kind, t.v);
    std::ranges::sort(key.second);
    return !seen.insert(key).second;
  });
  return found;
}

}  // namespace icloth
