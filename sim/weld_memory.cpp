#include "sim/weld_memory.h"

#include <algorithm>
#include <map>

#include "kernels/index.h"
#include "sim/collision/detect.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {
namespace {

// Keys of pairs, as in kernels/stencil.h.
constexpr std::uint64_t kEdgeBit = std::uint64_t{1} << 63, kHalf = (std::uint64_t{1} << 31) - 1;

/// Edge numbers of the world after a weld for those before it.
class NewKeys {
 public:
  NewKeys(const World& before, const WeldedScene& welded, const World& after)
      : before_(before), welded_(welded) {
    for (std::size_t e = 0; e < after.edge.size(); ++e)
      edge_[after.edge[e]] = static_cast<std::uint64_t>(e);
  }

  std::uint64_t of(std::uint64_t key) const {
    // A vertex and a face: faces keep their numbers.
    const std::uint64_t a = (key >> 31) & kHalf, b = key & kHalf;
    if ((key & kEdgeBit) == 0)
      return (static_cast<std::uint64_t>(welded_.vertex[static_cast<std::size_t>(a)]) << 31) | b;

    // Two edges, the smaller number first.
    const std::uint64_t first = edge(a), second = edge(b);
    return kEdgeBit | (std::min(first, second) << 31) | std::max(first, second);
  }

 private:
  std::uint64_t edge(std::uint64_t old) const {
    const auto& e = before_.edge[static_cast<std::size_t>(old)];
    const Index a = welded_.vertex[at(e[0])], b = welded_.vertex[at(e[1])];
    return edge_.at({std::min(a, b), std::max(a, b)});
  }

  const World& before_;
  const WeldedScene& welded_;
  std::map<std::array<Index, 2>, std::uint64_t> edge_;
};

/// Means of merged vertices weighted with mass; obstacles keep what they have.
std::vector<Vec3d> weighted_means(const std::vector<Vec3d>& values, const World& before,
                                  const WeldedScene& welded, std::size_t count) {
  std::vector<Vec3d> sum(count);
  std::vector<double> mass(count);
  for (std::size_t v = 0; v < values.size(); ++v) {
    const double m = v < before.mass.size() ? before.mass[v] : 1.0;
    sum[at(welded.vertex[v])] += m * values[v];
    mass[at(welded.vertex[v])] += m;
  }
  for (std::size_t v = 0; v < count; ++v) sum[v] = (1 / mass[v]) * sum[v];
  return sum;
}

/// A hand holds merged vertices once, with the sum of their shares.
void follow_hand(HeldPatch& hand, const WeldedScene& welded) {
  for (Index& corner : hand.corners) corner = welded.vertex[at(corner)];

  // The lists of vertices, shares and offsets are made anew.
  HeldPatch merged = hand;
  merged.vertices.clear(), merged.share.clear(), merged.offset.clear();
  for (std::size_t i = 0; i < hand.vertices.size(); ++i) {
    const Index v = welded.vertex[at(hand.vertices[i])];
    const auto known = std::ranges::find(merged.vertices, v);
    if (known == merged.vertices.end()) {
      merged.vertices.push_back(v);
      merged.share.push_back(hand.share[i]);
      merged.offset.push_back(hand.offset[i]);
      continue;
    }

    // The offset of a merged vertex is the mean of both, weighted with their shares.
    const auto k = static_cast<std::size_t>(known - merged.vertices.begin());
    const double sum = merged.share[k] + hand.share[i];
    if (sum > 0)
      merged.offset[k] =
          (1 / sum) * (merged.share[k] * merged.offset[k] + hand.share[i] * hand.offset[i]);
    merged.share[k] = sum;
  }
  hand = std::move(merged);
}

}  // namespace

std::vector<Vec3d> welded_positions(const Snapshot& state, const World& before,
                                    const WeldedScene& welded, const World& after,
                                    bool single_precision) {
  const std::size_t vertices = at(after.vertices);
  std::vector<Vec3d> sum(vertices);
  std::vector<double> count(vertices);
  std::vector<bool> held(vertices);

  // The first held vertex alone says where a merged one is.
  for (std::size_t v = 0; v < state.x1.size(); ++v) {
    const std::size_t to = at(welded.vertex[v]);
    if (held[to]) continue;
    const bool pinned = v < before.pinned.size() && before.pinned[v] != 0;
    if (pinned) {
      sum[to] = {};
      count[to] = 0;
      held[to] = true;
    }
    sum[to] += state.x1[v];
    ++count[to];
  }

  // Vertices that are not merged keep their bits.
  for (std::size_t v = 0; v < vertices; ++v) {
    if (count[v] == 1) continue;
    sum[v] = (1 / count[v]) * sum[v];
    if (single_precision) sum[v] = convert<double>(convert<float>(sum[v]));
  }
  return sum;
}

bool weld_is_free(const Snapshot& state, const World& before, const WeldedScene& welded,
                  const std::vector<Vec3d>& positions) {
  std::vector<Vec3d> end;
  for (const Index v : welded.vertex) end.push_back(positions[at(v)]);
  const Collisions found = cpu64::detect_collisions(state.x1, end, before.face);

  // A collision counts where cloth takes part and the elements do not share a vertex afterwards.
  const auto matters = [&](std::span<const Index> first, std::span<const Index> second) {
    bool cloth = false;
    for (const Index a : first) {
      cloth = cloth || a < before.cloth_vertices;
      for (const Index b : second) {
        cloth = cloth || b < before.cloth_vertices;
        if (welded.vertex[at(a)] == welded.vertex[at(b)]) return false;
      }
    }
    return cloth;
  };
  for (const auto& [vertex, face] : found.vertex_face)
    if (matters({&vertex, 1}, before.face[at(face)])) return false;
  for (const auto& v : found.edge_edge)
    if (matters({v.data(), 2}, {v.data() + 2, 2})) return false;

  // What shares a vertex afterwards is left to the exact test of the end.
  const SceneFaces soup = scene_faces(welded.scene);
  return find_intersections(positions, soup.faces, soup.group).empty();
}

Snapshot weld_memory(const Snapshot& state, const World& before, const WeldedScene& welded,
                     const World& after, const std::vector<Vec3d>& positions) {
  Snapshot s = state;
  const auto vertices = at(after.vertices), cloth = at(after.cloth_vertices);

  // Places are given, velocities follow from momentum.
  s.x1 = positions;
  s.v = weighted_means(state.v, before, welded, vertices);
  if (!state.past.motion.empty()) {
    s.past.motion = weighted_means(state.past.motion, before, welded, cloth);
    s.past.change = weighted_means(state.past.change, before, welded, cloth);
  }

  // Contacts keep their friction under the new numbers of their elements.
  const NewKeys keys(before, welded, after);
  for (auto& held : s.held) held.key = keys.of(held.key);
  std::ranges::sort(s.held, {}, [](const auto& held) { return held.key; });
  const auto same = [](const auto& a, const auto& b) { return a.key == b.key; };
  s.held.erase(std::unique(s.held.begin(), s.held.end(), same), s.held.end());

  // Gaps of merged vertices are the smaller ones; the candidate lists have to be made anew.
  if (!state.start_gap.empty()) {
    s.start_gap.assign(cloth, 1e30);
    for (std::size_t v = 0; v < state.start_gap.size(); ++v) {
      double& gap = s.start_gap[at(welded.vertex[v])];
      gap = std::min(gap, state.start_gap[v]);
    }
  }
  s.trusted_start.clear();
  s.trusted_end.clear();
  s.trusted_complete = false;

  // Merged vertices are let go from a body once.
  for (LetGo& entry : s.let_go) entry.vertex = welded.vertex[at(entry.vertex)];
  const auto order = [](const LetGo& e) { return std::pair(e.vertex, e.body); };
  std::ranges::sort(s.let_go, {}, order);
  const auto again = [&](const LetGo& a, const LetGo& b) { return order(a) == order(b); };
  s.let_go.erase(std::unique(s.let_go.begin(), s.let_go.end(), again), s.let_go.end());

  // The pairs that are left go on closing, and hands go on holding.
  s.stitches.clear();
  for (const Index pair : welded.pairs) s.stitches.push_back(state.stitches[at(pair)]);
  for (HeldPatch& hand : s.hands) follow_hand(hand, welded);
  return s;
}

}  // namespace icloth
