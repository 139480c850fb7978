// Repair of a start state: separates surfaces that go a little through each other.
#pragma once

#include "sim/scene/scene.h"

namespace icloth {

/// Moves cloth vertices (not pinned ones) until no faces intersect and what had crossed is apart by
/// the impact offset. The contours of intersection are traced, one side is decided for each of
/// them (sim/scene/repair_sides.h), and the vertices go to the closest positions in which every
/// element is on its side (sim/scene/repair_moves.h): no vertex moves further than the deepest
/// crossing and the offset together. What is deeper than `limit` [m] is left, and so are surfaces
/// that only touch, since no side is known for them. The rest shape stays. Also writes
/// scene.repair.
StartRepair repair_start(Scene& scene, double limit);

}  // namespace icloth
