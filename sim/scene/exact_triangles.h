// Whether two triangles meet, decided without rounding for all finite coordinates.
#pragma once

#include <array>

#include "kernels/vec.h"

namespace icloth {

using FaceCorners = std::array<Vec3d, 3>;

/// Side of d against the plane a b c: −1 or +1 when it is certain in spite of rounding, else 0.
int certain_side(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

/// The same without doubt: 0 only for four points in one plane. Exact integers decide where
/// rounding leaves it open.
int exact_side(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

/// True when the closed triangles have a point in common; touching counts. Triangles without area
/// meet nothing.
bool triangles_meet(const FaceCorners& s, const FaceCorners& t);

/// True when the point lies in the closed triangle, exactly.
bool point_meets(Vec3d p, const FaceCorners& t);

/// True when the closed segments a b and c d have a point in common, exactly.
bool segments_meet(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

}  // namespace icloth
