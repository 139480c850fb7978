// How far apart two places of a cloth are at rest, where it is sewn of panels.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// A vertex and the square of how far it is at rest from the one whose list it is in.
struct RestDistance {
  Index vertex = 0;
  double squared = 0;  ///< [m²]
};

/// Inside a panel the distance at rest is that of the material coordinates. Across a seam no
/// coordinates hold for both sides, so the vertices around seams list each other.
struct RestDistances {
  /// Panel of each vertex, kNone for one on a seam, which lies at several places of the pattern.
  std::vector<Index> panel;
  std::vector<Index> first;             ///< where the list of a vertex begins (vertices + 1)
  std::vector<RestDistance> distances;  ///< in each list sorted by vertex, larger numbers alone
};

/// Vertices up to so many edges apart are listed around seams. Pairs that are nearer than twice the
/// contact thickness, which is at most 0.3 edges, have their corners within that.
inline constexpr int kListedRings = 3;

/// Distances of one sewn cloth: `corners` are its material coordinates [m], (F). The distance
/// across a seam is the shortest one over a vertex of the seam, straight on both sides.
RestDistances rest_distances(std::span<const Triangle> faces, std::size_t vertices,
                             const std::vector<std::array<Vec2d, 3>>& corners);

}  // namespace icloth
