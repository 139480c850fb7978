// How far the faces of sewn cloth are stretched, for judging a garment.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/scene/world.h"

namespace icloth {

/// Largest principal stretch − 1 of a cloth face whose corners are at x [m].
double face_strain(const World& world, Index face, const std::array<Vec3d, 3>& x);
/// The same of each cloth face at the given positions [m]; (cloth_faces).
std::vector<double> face_strains(const World& world, std::span<const Vec3d> positions);

/// The value that the share `share` of all values does not exceed; 0 of none.
double percentile(std::vector<double> values, double share);

}  // namespace icloth
