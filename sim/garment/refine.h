// Garments of many triangles are put on in few of them, and then refined where they hang: each
// triangle is cut into four in its plane. The surface stays the same set of points, therefore what
// does not intersect before does not intersect afterwards.
#pragma once

#include "sim/scene/scene.h"

namespace icloth {

/// How often the garments of a scene are refined after they were put on. 0 also where a scene holds
/// vertices by their numbers, with pins or seams.
int refinements(const Scene& scene);

/// The scene with its garments in the triangles of the coarsest level.
Scene coarsest_scene(const Scene& scene);

/// Takes the garments of `scene` from `level`, 0 for the coarsest, to the next finer one. A garment
/// that has no finer one stays as it is.
void refine_garments(Scene& scene, int level);

}  // namespace icloth
