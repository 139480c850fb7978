// Repair of a start state: separates surfaces that go a little through each other.
#pragma once

#include "sim/scene/scene.h"

namespace icloth {

/// Moves cloth vertices (not pinned ones) until no faces intersect and what had crossed is apart by
/// the impact offset. The contours of intersection are traced, and one side is decided for each of
/// them (sim/scene/repair_sides.h): one surface above the other, or both beside each other along
/// borders (sim/scene/repair_seams.h). The vertices go to the closest positions in which every
/// element is on its side (sim/scene/repair_moves.h): no vertex moves further than the deepest
/// crossing and the offset together. What that leaves is parted as bodies are, first the faces of
/// a contour together, then pair by pair (sim/scene/repair_hulls.h). Moves count only where they
/// leave fewer pairs than before (sim/scene/repair_clusters.h), so the scene never gets worse.
///
/// What is deeper than `limit` [m] is left, and so are surfaces that only touch, since no side is
/// known for them. The repair ends after a fixed amount of work, about 10 s for 10,000 faces, or
/// after the share `work` of it. The rest shape stays. Also writes scene.repair.
StartRepair repair_start(Scene& scene, double limit, double work = 1);

}  // namespace icloth
