#include "sim/scene/repair_hulls.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "kernels/index.h"

namespace icloth {
namespace {

constexpr std::size_t kMostSegments = 12;  ///< longer contours bend around each other

std::vector<Index> sorted(std::vector<Index> list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

/// The faces of one sheet along a contour.
struct Patch {
  std::vector<Index> faces, vertices;

  Patch(const RepairMesh& mesh, std::vector<Index> list) : faces(sorted(std::move(list))) {
    for (const Index f : faces)
      for (const Index v : mesh.faces[at(f)]) vertices.push_back(v);
    vertices = sorted(std::move(vertices));
  }
};

std::array<Patch, 2> patches(const RepairMesh& mesh, const Contour& contour) {
  std::vector<Index> own, other;
  for (const Contour::Segment& s : contour.segments) {
    own.push_back(s.own);
    other.push_back(s.other);
  }
  return {Patch(mesh, std::move(own)), Patch(mesh, std::move(other))};
}

/// Edges of the faces of a patch.
std::vector<Vec3d> sides(const RepairMesh& mesh, const Patch& patch) {
  std::vector<Index> edges;
  for (const Index f : patch.faces)
    for (const Index e : mesh.face_edges[at(f)]) edges.push_back(e);
  std::vector<Vec3d> directions;
  for (const Index e : sorted(std::move(edges)))
    directions.push_back(mesh.position(mesh.edges[at(e)][1]) - mesh.position(mesh.edges[at(e)][0]));
  return directions;
}

struct Separation {
  Vec3d apart;  ///< 0 where there is none
  double depth = 0;
};

Separation separate_hulls(const RepairMesh& mesh, const Contour& contour) {
  const std::array<Patch, 2> both = patches(mesh, contour);
  const Patch &own = both[0], &other = both[1];
  std::vector<Index> common;
  std::ranges::set_intersection(own.vertices, other.vertices, std::back_inserter(common));
  const auto is_free = [&](Index v) { return mesh.is_free(v); };
  if (!common.empty() || (std::ranges::none_of(own.vertices, is_free) &&
                          std::ranges::none_of(other.vertices, is_free)))
    return {};

  // How far the own vertices have to go along a direction, and along its opposite.
  Separation best;
  double least = std::numeric_limits<double>::infinity();
  const auto try_direction = [&](Vec3d direction) {
    const Vec3d d = normalized(direction);
    if (!(norm2(d) > 0)) return;
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::array<double, 2> low{inf, inf}, high{-inf, -inf};
    for (const std::size_t side : {0u, 1u})
      for (const Index v : (side == 0 ? own : other).vertices) {
        const double height = dot(d, mesh.position(v));
        low[side] = std::min(low[side], height);
        high[side] = std::max(high[side], height);
      }
    for (const double sign : {1.0, -1.0}) {
      const double depth = sign > 0 ? high[1] - low[0] : high[0] - low[1];
      if (!(depth < least)) continue;
      least = depth;
      best = {sign * d, std::max(0.0, depth)};
    }
  };

  // Triangles separate along the normal of one of them or across an edge of each.
  for (const Patch* patch : {&own, &other})
    for (const Index f : patch->faces) try_direction(mesh.normal(f));
  const std::vector<Vec3d> others = sides(mesh, other);
  for (const Vec3d& u : sides(mesh, own))
    for (const Vec3d& v : others)
      if (norm2(cross(u, v)) > 1e-6 * norm2(u) * norm2(v)) try_direction(cross(u, v));
  return best;
}

}  // namespace

std::vector<Side> choose_hulls(const RepairMesh& mesh, std::span<const Contour> contours,
                               double limit) {
  std::vector<Side> sides(contours.size());
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const std::size_t twin = contours[c].twin;
    if (twin <= c || contours[c].segments.size() > kMostSegments) continue;
    if (contours[c].piercings.empty() && contours[twin].piercings.empty()) continue;
    const Separation s = separate_hulls(mesh, contours[c]);
    if (!(norm2(s.apart) > 0) || s.depth > limit) continue;
    sides[c].apart = s.apart;
    sides[twin].apart = -s.apart;
    sides[c].depth = sides[twin].depth = s.depth;
  }
  return sides;
}

std::vector<GapConstraint> keep_hulls_apart(const RepairMesh& mesh, const Contour& contour,
                                            Vec3d apart, double offset) {
  const auto [own, other] = patches(mesh, contour);
  std::vector<GapConstraint> constraints;
  for (const Index v : own.vertices)
    for (const Index w : other.vertices)
      constraints.push_back({{v, w, w, w}, {1, -1, 0, 0}, apart, offset});
  return constraints;
}

std::vector<Contour> split_into_pairs(std::span<const Contour> contours) {
  std::vector<Contour> pairs;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const Contour &own = contours[c], &twin = contours[own.twin];
    if (own.twin < c || (own.piercings.empty() && twin.piercings.empty())) continue;
    for (const auto& [f, g] : own.segments) {
      if (own.twin == c && f > g) continue;  // both views in one list
      const std::size_t first = pairs.size();
      pairs.push_back({{{f, g}}, own.piercings, first + 1});
      pairs.push_back({{{g, f}}, twin.piercings, first});
    }
  }
  return pairs;
}

}  // namespace icloth
