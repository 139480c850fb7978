// Cuts the polygons of mesh files into triangles.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/files/mesh_io.h"

namespace icloth {

/// Corners that one polygon may have.
inline constexpr std::size_t kMostCorners = 100'000;

/// Cuts a polygon by ear clipping, seen along its Newell normal: it may be concave, have corners in
/// a straight line, touch itself, turn either way and be slightly bent. Appends triangles of corner
/// numbers that turn as the polygon does and together cover it once. Corners that repeat the place
/// of the one before are left out. A triangle and a convex polygon of at most 32 corners, none of
/// them straight, become a fan around the first corner.
///
/// Returns an empty text, or what was expected of a polygon that cannot be cut: it crosses itself,
/// spans no area, has more than kMostCorners corners, or is so entangled that the cut would take
/// long. Nothing is appended then.
std::string cut_polygon(std::span<const Vec3d> corners, std::vector<Triangle>& triangles);

/// Whether two files have the same vertices and faces, however their polygons are cut.
bool same_faces(const MeshFile& a, const MeshFile& b);

/// Cuts the polygons of a file as those of another one with the same faces; the texture coordinates
/// go with the corners.
void cut_like(const MeshFile& pattern, MeshFile& file);

}  // namespace icloth
