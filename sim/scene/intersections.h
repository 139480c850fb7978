// Exact intersection test of triangle soups: start states, `icloth check`, tests.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh.h"
#include "sim/scene/scene.h"

namespace icloth {

struct IntersectingFaces {
  Index a, b;  ///< face numbers in the soup, a < b
};

/// Every pair of faces that touches or crosses and shares no vertex, sorted. Exact for the given
/// doubles. Faces with group[f] < 0 are not tested among themselves (obstacles).
/// `group` may be empty (all faces are tested against all).
std::vector<IntersectingFaces> find_intersections(std::span<const Vec3d> positions,
                                                  std::span<const Triangle> faces,
                                                  std::span<const int> group);

/// Intersections of a scene's start state, rounded to single precision when `single_precision`;
/// face numbers count cloths in scene order, then obstacles. Obstacle pairs are left out.
std::vector<IntersectingFaces> find_start_intersections(const Scene& scene, bool single_precision);

}  // namespace icloth
