#include "sim/scene/repair_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "kernels/index.h"

namespace icloth {
namespace {

/// Two sheets are taken as layers of each other up to this cosine of the angle between them (about
/// 70°); steeper ones meet with a border, and the one says nothing about the side of the other.
constexpr double kLayers = 0.34;

/// The regions of one sheet that have to move when it shall be on one side of the other.
struct Fill {
  bool possible = true;  ///< nothing is deeper than the limit
  double depth = 0;      ///< deepest place [m]
  bool measured = true;  ///< the depth is one of points, not an estimate from faces
  double volume = 0;     ///< between the regions and the other sheet [m³]
  std::vector<WrongVertex> wrong;
};

double vertex_area(const RepairMesh& mesh, Index v) {
  double area = 0;
  for (const Index f : mesh.vertex_faces[v]) {
    const auto c = mesh.corners(f);
    area += norm(cross(c[1] - c[0], c[2] - c[0])) / 6;
  }
  return area;
}

/// How far face f has to be moved to lie wholly on the side `sign` of face g: the least over the
/// directions in which triangles separate, as far as they point roughly to that side.
double pair_depth(const RepairMesh& mesh, Index f, Index g, int sign) {
  const auto s = mesh.corners(f), t = mesh.corners(g);
  const Vec3d side = double(sign) * mesh.normal(g);
  double least = std::numeric_limits<double>::infinity();
  const auto try_direction = [&](Vec3d direction) {
    const Vec3d d = normalized(dot(direction, side) < 0 ? -direction : direction);
    if (!(dot(d, side) > kLayers)) return;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < 3; ++k) {
      low = std::min(low, dot(d, s[k] - t[0]));
      high = std::max(high, dot(d, t[k] - t[0]));
    }
    least = std::min(least, high - low);
  };

  // Triangles separate along the normal of a face or a common normal of their edges.
  try_direction(mesh.normal(f));
  try_direction(mesh.normal(g));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      try_direction(cross(s[(i + 1) % 3] - s[i], t[(j + 1) % 3] - t[j]));
  return least;
}

/// Middles of the parts of edges between two faces that they go through, each with such a face.
std::vector<std::pair<Vec3d, Index>> between_piercings(const RepairMesh& mesh,
                                                       const Contour& contour) {
  // The places at which an edge goes through faces are measured along the edge.
  std::map<Index, std::vector<std::pair<double, Index>>> places;
  for (const Piercing& p : contour.piercings) {
    const auto [a, b] = mesh.edges[at(p.edge)];
    const Vec3d n = mesh.normal(p.face), on = mesh.corners(p.face)[0];
    const double from = dot(n, mesh.position(a) - on), to = dot(n, mesh.position(b) - on);
    if (from != to) places[p.edge].emplace_back(from / (from - to), p.face);
  }

  std::vector<std::pair<Vec3d, Index>> middles;
  for (auto& [edge, list] : places) {
    std::ranges::sort(list);
    const auto [a, b] = mesh.edges[at(edge)];
    for (std::size_t i = 0; i + 1 < list.size(); ++i) {
      const double middle = 0.5 * (list[i].first + list[i + 1].first);
      middles.emplace_back(mesh.position(a) + middle * (mesh.position(b) - mesh.position(a)),
                           list[i].second);
    }
  }
  return middles;
}

/// Fills the regions on the wrong side, from the ends of the edges that go through.
Fill fill_regions(const RepairMesh& mesh, const Contour& contour, int sign, double limit) {
  Fill fill;
  std::set<Index> seen;
  std::vector<std::pair<Index, Index>> front;  // a vertex, and a face of the other sheet near it
  for (const Piercing& p : contour.piercings) {
    const Index end = sign > 0 ? p.below : p.above;
    if (seen.insert(end).second) front.emplace_back(end, p.face);
  }

  // A region ends where its vertices are on the right side, or beyond the border of the other
  // sheet.
  for (std::size_t next = 0; next < front.size(); ++next) {
    const auto [v, near] = front[next];
    const SurfacePoint closest = walk_to_closest(mesh, mesh.position(v), near);
    const double depth = -sign * closest.height;
    if (closest.beyond || !(depth > 0)) continue;
    fill.depth = std::max(fill.depth, depth);
    fill.volume += depth * vertex_area(mesh, v);
    fill.wrong.push_back({v, closest.face, depth});
    if (depth > limit) {
      fill.possible = false;
      return fill;
    }
    for (const Index f : mesh.vertex_faces[v])
      for (const Index neighbour : mesh.faces[at(f)])
        if (seen.insert(neighbour).second) front.emplace_back(neighbour, closest.face);
  }

  // Edges may be deeper than their ends: between two places where they go through.
  for (const auto& [p, face] : between_piercings(mesh, contour)) {
    const SurfacePoint closest = walk_to_closest(mesh, p, face);
    const double depth = -sign * closest.height;
    if (!closest.beyond && depth <= limit) fill.depth = std::max(fill.depth, depth);
  }

  // When no point has a depth, that of the faces which cross is the estimate.
  fill.measured = fill.depth > 0;
  for (const Contour::Segment& s : contour.segments) {
    const double depth = pair_depth(mesh, s.own, s.other, sign);
    fill.volume += 1e-12 * depth;  // decides only between regions without vertices
    if (!fill.measured && depth <= limit) fill.depth = std::max(fill.depth, depth);
  }
  return fill;
}

/// Mean cosine of the angle between the two sheets along a contour.
double mean_cosine(const RepairMesh& mesh, const Contour& contour) {
  double sum = 0;
  for (const Contour::Segment& s : contour.segments)
    sum += dot(mesh.normal(s.own), mesh.normal(s.other));
  return sum / static_cast<double>(contour.segments.size());
}

/// Sets whose members have equal or opposite signs.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parent_(count), sign_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// The set of i, and the sign of i against it.
  std::pair<std::size_t, int> find(std::size_t i) const {
    int sign = 1;
    for (; parent_[i] != i; i = parent_[i]) sign *= sign_[i];
    return {i, sign};
  }
  /// A contradiction to what is known already is passed over: the first word counts.
  void unite(std::size_t i, std::size_t j, int sign) {
    const auto [a, a_sign] = find(i);
    const auto [b, b_sign] = find(j);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    sign_[std::max(a, b)] = a_sign * b_sign * sign;
  }

 private:
  std::vector<std::size_t> parent_;
  std::vector<int> sign_;
};

using Fills = std::vector<std::array<Fill, 2>>;  ///< for the signs +1 and −1

/// Unites contours that bound a common region: the same vertex over the same part of the other
/// sheet, on the same side of it.
void unite_by_regions(const RepairMesh& mesh, const Fills& fills, SignedSets& sets) {
  struct Known {
    std::size_t contour;
    Index face;
  };
  std::array<std::map<Index, std::vector<Known>>, 2> known;

  // Two places on the other sheet are next to each other when their faces share a vertex.
  const auto touch = [&](Index f, Index g) {
    for (const Index v : mesh.faces[at(f)])
      if (std::ranges::find(mesh.faces[at(g)], v) != mesh.faces[at(g)].end()) return true;
    return false;
  };

  // Wrong vertices are remembered with their contours, by which later contours find them.
  for (std::size_t c = 0; c < fills.size(); ++c)
    for (std::size_t s = 0; s < 2; ++s)
      for (const WrongVertex& wrong : fills[c][s].wrong) {
        auto& list = known[s][wrong.vertex];
        for (const Known& k : list)
          if (k.contour != c && touch(k.face, wrong.face)) sets.unite(k.contour, c, 1);
        if (list.empty() || list.back().contour != c) list.push_back({c, wrong.face});
      }
}

/// Unites contours that pass next to each other: their faces have a vertex in common on both
/// sheets.
void unite_neighbours(const RepairMesh& mesh, std::span<const Contour> contours, SignedSets& sets) {
  std::map<std::pair<Index, Index>, std::size_t> known;
  for (std::size_t c = 0; c < contours.size(); ++c)
    for (const Contour::Segment& s : contours[c].segments)
      for (const Index v : mesh.faces[at(s.own)])
        for (const Index w : mesh.faces[at(s.other)])
          sets.unite(known.try_emplace({v, w}, c).first->second, c, 1);
}

/// The cost of an orientation of a set of contours. Views that are too deep count before volume.
struct Cost {
  int forbidden = 0;  ///< views with cloth inside a body
  int too_deep = 0;
  double volume = 0;  ///< [m³]
  auto operator<=>(const Cost&) const = default;
};

}  // namespace

std::vector<Side> choose_sides(const RepairMesh& mesh, std::span<const Contour> contours,
                               double limit) {
  // Every view has two possible sides, each with the regions that would have to move.
  Fills fills(contours.size());
  for (std::size_t c = 0; c < contours.size(); ++c)
    fills[c] = {fill_regions(mesh, contours[c], 1, limit),
                fill_regions(mesh, contours[c], -1, limit)};

  // A sheet above another that faces the same way has that other one below it.
  SignedSets sets(contours.size());
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const double cosine = mean_cosine(mesh, contours[c]);
    if (contours[c].twin > c && std::fabs(cosine) > kLayers)
      sets.unite(c, contours[c].twin, cosine > 0 ? -1 : 1);
  }
  unite_by_regions(mesh, fills, sets);
  unite_neighbours(mesh, contours, sets);

  // The cost of both orientations of every set.
  std::vector<std::array<Cost, 2>> costs(contours.size());
  std::vector<std::uint8_t> goes_through(contours.size(), 0);
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const auto [set, sign] = sets.find(c);
    if (!contours[c].piercings.empty()) goes_through[set] = 1;
    for (std::size_t s = 0; s < 2; ++s) {
      const std::size_t own = sign > 0 ? s : 1 - s;
      Cost& cost = costs[set][s];
      cost.forbidden += own == 1 && mesh.is_body(contours[c].segments.front().other) ? 1 : 0;
      cost.too_deep += fills[c][own].possible ? 0 : 1;
      cost.volume += fills[c][own].possible ? fills[c][own].volume : 0;
    }
  }

  // A contour without a measured depth takes that of the other contours of its set.
  const auto chosen_sign = [&](std::size_t c) {
    const auto [set, sign] = sets.find(c);
    return (costs[set][1] < costs[set][0] ? -1 : 1) * sign;
  };
  std::vector<double> measured(contours.size(), 0);
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const Fill& fill = fills[c][chosen_sign(c) > 0 ? 0 : 1];
    double& most = measured[sets.find(c).first];
    if (fill.possible && fill.measured) most = std::max(most, fill.depth);
  }

  // The cheaper one counts; views that are too deep in it have no side, nor have sheets that only
  // touch.
  std::vector<Side> sides(contours.size());
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const std::size_t set = sets.find(c).first;
    const int sign = chosen_sign(c);
    Fill& fill = fills[c][sign > 0 ? 0 : 1];
    if (!fill.possible || goes_through[set] == 0) continue;
    const bool estimated = !fill.measured && measured[set] > 0;
    sides[c] = {sign, estimated ? measured[set] : fill.depth, false, {}, std::move(fill.wrong)};
  }
  return sides;
}

}  // namespace icloth
