// One change of topology: the two sides of a seam become one row of vertices.
#pragma once

#include <optional>
#include <vector>

#include "sim/scene/seam_pairs.h"

namespace icloth {

struct WeldedScene {
  Scene scene;  ///< the seam has no pairs any more
  /// New number in the world of each old vertex, obstacles included (vertices).
  std::vector<Index> vertex;
  std::vector<Index> pairs;  ///< old number of each stitched pair that is left, in all seams
};

/// Merges the pairs of a seam. Faces keep their order and their rest shapes: the rest shape of the
/// cloth becomes its material space. None where the seam joins two cloths, or where a face would
/// lose a corner.
std::optional<WeldedScene> weld_seam(const Scene& scene, const World& world, Index seam);

}  // namespace icloth
