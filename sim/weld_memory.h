// The state of a simulation carried over to the scene after a weld (sim/sewing_simulator.h).
#pragma once

#include "sim/scene/seam_weld.h"
#include "sim/state/memory.h"

namespace icloth {

/// Where the vertices of the scene after a weld are (vertices) [m]: merged ones halfway between
/// those that they were, or where a held one stays. `single_precision`: they are numbers that the
/// build can hold.
std::vector<Vec3d> welded_positions(const Snapshot& state, const World& before,
                                    const WeldedScene& welded, const World& after,
                                    bool single_precision);

/// Whether the way from the state to the welded positions takes nothing through anything, and the
/// welded scene does not intersect. Elements that share a vertex afterwards may meet on the way,
/// and bodies may touch each other.
bool weld_is_free(const Snapshot& state, const World& before, const WeldedScene& welded,
                  const std::vector<Vec3d>& positions);

/// The state after a weld, at such positions. Velocities of merged vertices are means weighted with
/// mass, so that momentum is kept.
Snapshot weld_memory(const Snapshot& state, const World& before, const WeldedScene& welded,
                     const World& after, const std::vector<Vec3d>& positions);

}  // namespace icloth
