// A seam of a delivered garment, welded before the simulation.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/intersections.h"
#include "sim/scene/scene.h"

namespace icloth {

/// A garment whose panels were sewn.
struct SewnPanels {
  Scene scene;            ///< without the seam
  std::size_t pairs = 0;  ///< of faces that intersected when it was sewn
  StartRepair repair;     ///< what parted them
  std::vector<IntersectingFaces> left;
  std::size_t open = 0;  ///< pairs of the seam that were not sewn
};

/// Makes one vertex of every pair of a seam, halfway between the two, and parts what then
/// intersects as repair_start does. Beside faces that cannot be parted, pairs stay open, in up to
/// four rings. Throws InputError that begins with `source` where faces would lose their area.
SewnPanels sew_seam(const Scene& scene, const Seam& seam, const std::string& source);

}  // namespace icloth
