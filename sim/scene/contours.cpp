#include "sim/scene/contours.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "kernels/index.h"
#include "sim/files/disjoint_sets.h"
#include "sim/scene/exact_triangles.h"

namespace icloth {
namespace {

/// The edge through the face, where it goes through.
std::optional<Piercing> pierce(const RepairMesh& mesh, Index edge, Index face) {
  const auto [a, b] = mesh.edges[at(edge)];
  const Vec3d p = mesh.position(a), q = mesh.position(b);
  const FaceCorners t = mesh.corners(face);

  // The ends have to be on different sides of the plane. exact_side is negative above the face.
  const bool a_above = exact_side(t[0], t[1], t[2], p) <= 0;
  const bool b_above = exact_side(t[0], t[1], t[2], q) <= 0;
  if (a_above == b_above) return {};

  // The line has to pass the three sides of the face in the same sense.
  bool left = false, right = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = exact_side(p, q, t[k], t[(k + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
  }
  if (left && right) return {};
  return Piercing{edge, face, a_above ? a : b, a_above ? b : a};
}

}  // namespace

std::vector<Contour> trace_contours(const RepairMesh& mesh,
                                    std::span<const IntersectingFaces> pairs) {
  // Segment 2i is pair i as its first face sees it, segment 2i + 1 as its second one does.
  std::vector<Contour::Segment> segments;
  for (const IntersectingFaces& pair : pairs) {
    segments.push_back({pair.a, pair.b});
    segments.push_back({pair.b, pair.a});
  }

  // Segments with a common end belong to one contour. An end is an edge through a face, either of
  // the own sheet (0) or of the other one (1).
  DisjointSets sets(segments.size());
  std::map<std::tuple<int, Index, Index>, std::size_t> ends;
  std::vector<std::pair<std::size_t, Piercing>> piercings;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto [own, other] = segments[s];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index edge = mesh.face_edges[at(own)][k];
      const auto piercing = pierce(mesh, edge, other);
      if (!piercing) continue;
      const auto [mine, mine_is_new] = ends.try_emplace({0, edge, other}, s);
      if (mine_is_new) piercings.emplace_back(s, *piercing);
      sets.unite(mine->second, s);
      const auto [twins, twins_is_new] = ends.try_emplace({1, edge, other}, s ^ 1u);
      if (!twins_is_new) sets.unite(twins->second, s ^ 1u);
    }
  }

  // Contours are numbered by their first segments.
  std::vector<Contour> contours;
  std::vector<std::size_t> number(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const std::size_t root = sets.find(s);
    if (root == s) contours.emplace_back();
    number[s] = root == s ? contours.size() - 1 : number[root];
    contours[number[s]].segments.push_back(segments[s]);
  }
  for (std::size_t s = 0; s < segments.size(); ++s) contours[number[s]].twin = number[s ^ 1u];
  for (const auto& [s, piercing] : piercings) contours[number[s]].piercings.push_back(piercing);
  return contours;
}

}  // namespace icloth
