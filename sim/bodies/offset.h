// A skin that lies outside the surface of its body, so that cloth keeps away from it.
#pragma once

#include <array>
#include <vector>

#include "sim/bodies/rig.h"

namespace icloth {

/// Moves each vertex along its normal, the mean of those of its faces by area [m].
void offset_along_normals(std::vector<Vec3d>& positions,
                          const std::vector<std::array<Index, 3>>& faces, double distance);
void offset_along_normals(std::vector<Vec3f>& positions,
                          const std::vector<std::array<Index, 3>>& faces, double distance);

/// Changes the rest positions of a rig so that its bind pose, placed, is offset by the distance. In
/// other poses the offset turns with the bones.
void offset_rig(Rig& rig, const Affine& place, const std::vector<std::array<Index, 3>>& faces,
                double distance);

}  // namespace icloth
