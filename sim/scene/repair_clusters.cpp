#include "sim/scene/repair_clusters.h"

#include <algorithm>
#include <numeric>

#include "kernels/index.h"

namespace icloth {
namespace {

constexpr int kMostReturns = 4;  ///< looks for pairs that moves taken back have made

/// Clusters of moved vertices; the smallest vertex stands for its cluster.
class Clusters {
 public:
  Clusters(const RepairMesh& mesh, std::span<const Vec3d> before)
      : mesh_(mesh), parent_(mesh.x.size()), moved_(mesh.x.size()) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
    for (std::size_t v = 0; v < moved_.size(); ++v) moved_[v] = mesh.x[v] != before[v];
    for (const Triangle& t : mesh.faces) join(t);
  }

  void join(std::span<const Index> vertices) {
    Index first = -1;
    for (const Index v : vertices) {
      if (!moved_[at(v)]) continue;
      if (first >= 0) unite(first, v);
      first = v;
    }
  }
  void join(const IntersectingFaces& pair) {
    const Triangle &s = mesh_.faces[at(pair.a)], &t = mesh_.faces[at(pair.b)];
    join(std::array{s[0], s[1], s[2], t[0], t[1], t[2]});
  }

  /// The cluster of a pair, −1 where nothing of it has moved.
  Index of(const IntersectingFaces& pair) {
    for (const Index f : {pair.a, pair.b})
      for (const Index v : mesh_.faces[at(f)])
        if (moved_[at(v)]) return find(v);
    return -1;
  }
  Index find(Index v) {
    while (parent_[at(v)] != v) v = parent_[at(v)] = parent_[at(parent_[at(v)])];
    return v;
  }
  bool is_moved(Index v) const { return moved_[at(v)] != 0; }

 private:
  void unite(Index v, Index w) {
    const Index a = find(v), b = find(w);
    parent_[at(std::max(a, b))] = std::min(a, b);
  }

  const RepairMesh& mesh_;
  std::vector<Index> parent_;
  std::vector<std::uint8_t> moved_;
};

}  // namespace

std::vector<IntersectingFaces> find_intersections(const RepairMesh& mesh) {
  return find_intersections(mesh.x, mesh.faces, mesh.group);
}

std::vector<IntersectingFaces> keep_what_pays(RepairMesh& mesh, const Trial& trial) {
  std::vector<IntersectingFaces> pairs = find_intersections(mesh);
  for (int round = 0; round < kMostReturns; ++round) {
    // What depends on each other.
    Clusters clusters(mesh, trial.before);
    for (const IntersectingFaces& pair : trial.pairs) clusters.join(pair);
    for (const IntersectingFaces& pair : pairs) clusters.join(pair);
    for (const GapConstraint& c : trial.constraints) clusters.join(c.v);

    // How many pairs every cluster had and has.
    std::vector<std::array<std::size_t, 2>> count(mesh.x.size());
    for (const IntersectingFaces& pair : trial.pairs)
      if (const Index c = clusters.of(pair); c >= 0) ++count[at(c)][0];
    for (const IntersectingFaces& pair : pairs)
      if (const Index c = clusters.of(pair); c >= 0) ++count[at(c)][1];

    // No cluster may have a vertex that went too far.
    std::vector<std::uint8_t> too_far(mesh.x.size(), 0);
    for (std::size_t v = 0; v < mesh.x.size(); ++v)
      if (norm(mesh.x[v] - mesh.start[v]) > trial.limit + 1e-6)
        too_far[at(clusters.find(static_cast<Index>(v)))] = 1;

    // The way back may lead through what has stayed: that is looked for in the next round.
    bool returned = false;
    for (std::size_t v = 0; v < mesh.x.size(); ++v) {
      if (!clusters.is_moved(static_cast<Index>(v))) continue;
      const std::size_t c = at(clusters.find(static_cast<Index>(v)));
      const auto [had, has] = count[c];
      const bool pays = has < had || (trial.for_room && has == had);
      if (pays && !too_far[c]) continue;
      mesh.x[v] = trial.before[v];
      returned = true;
    }
    if (!returned) return pairs;
    pairs = find_intersections(mesh);
  }

  if (pairs.size() <= trial.pairs.size()) return pairs;
  std::ranges::copy(trial.before, mesh.x.begin());
  return {trial.pairs.begin(), trial.pairs.end()};
}

}  // namespace icloth
