// The open seams of a scene as pairs of vertices of its world.
#pragma once

#include <vector>

#include "sim/scene/world.h"

namespace icloth {

/// Two vertices that a seam draws together.
struct StitchedPair {
  Index a = 0, b = 0;  ///< vertices of the world
  Index seam = 0;      ///< number in the scene
  bool pulls = true;   ///< see Seam
};

/// The pairs of all seams, in the order of the scene.
std::vector<StitchedPair> stitched_pairs(const Scene& scene, const World& world);

/// For each cloth vertex the vertices that are neighbours across a seam, sorted: those in the ring
/// around one side of a pair have those in the ring around the other side. Symmetric.
struct SeamNeighbours {
  std::vector<Index> first;   ///< (cloth_vertices + 1); empty: there is no seam
  std::vector<Index> vertex;  ///< the lists
};
SeamNeighbours seam_neighbours(const World& world, const std::vector<StitchedPair>& pairs);

/// Pairs of a seam that are at most this far apart may be welded [m].
double weld_tolerance(double median_edge);

/// Smallest distance that impacts leave between the two sides of a seam, in place of
/// impact_zones.offset [m].
inline constexpr double kSeamOffset = 1e-5;

}  // namespace icloth
