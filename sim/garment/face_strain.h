// How far the faces of sewn cloth are stretched, for judging a garment.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/world.h"

namespace icloth {

/// Largest principal stretch − 1 of each cloth face at the given positions [m]; (cloth_faces).
std::vector<double> face_strains(const World& world, std::span<const Vec3d> positions);

/// The value that the share `share` of all values does not exceed; 0 of none.
double percentile(std::vector<double> values, double share);

}  // namespace icloth
