// Repair of a start state: separates faces that intersect a little.
#pragma once

#include "sim/scene/scene.h"

namespace icloth {

/// Moves cloth vertices (not pinned ones) until no faces intersect: every edge that pierces a face
/// is pushed back through it by its shallower end, out of closed bodies, a little further than
/// the impact offset. Vertices move by at most `limit` [m] in all. What is deeper is left, and so
/// is what goes through another cloth over more than an edge or two: its sides cannot be told. The
/// rest shape stays. Also writes scene.repair.
StartRepair repair_start(Scene& scene, double limit);

}  // namespace icloth
