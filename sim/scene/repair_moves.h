// The smallest motion that brings every element to its side of the others.
#pragma once

#include <cstdint>
#include <span>

#include "sim/scene/repair_constraints.h"

namespace icloth {

/// Writes mesh.x: of all positions that fulfil the constraints the ones closest to mesh.base, no
/// vertex further than `limit` [m] from it. Constraints are fulfilled to `tolerance` [m] where they
/// can be. The constraints looked at are taken off `work`; at 0 the moves are what has been
/// reached.
void move_vertices(RepairMesh& mesh, std::span<const GapConstraint> constraints, double limit,
                   double tolerance, std::int64_t& work);

}  // namespace icloth
