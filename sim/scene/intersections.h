// Exact intersection test of triangle soups: start states, `icloth check`, tests.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh.h"
#include "sim/scene/scene.h"
#include "sim/scene/touching.h"

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

/// Faces that touch or cross in the start state of a scene, which cannot be simulated then. Numbers
/// count cloths in scene order, then obstacles.
struct StartConflicts {
  std::vector<IntersectingFaces> pairs;  ///< faces without a common vertex that touch or cross
  std::vector<Touch> touches;            ///< of neighbouring faces, with a vertex that can move
};
/// `single_precision`: positions are rounded first, as the builds in single precision see them.
StartConflicts find_start_conflicts(const Scene& scene, bool single_precision);

/// All pairs of faces of the conflicts, neighbours included, sorted.
std::vector<IntersectingFaces> face_pairs(const StartConflicts& conflicts);
/// The same for the conflicts that are found in a scene.
std::vector<IntersectingFaces> find_start_intersections(const Scene& scene, bool single_precision);

}  // namespace icloth
