// Which moves of a repair are kept: faces that depend on each other are judged together.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/repair_constraints.h"

namespace icloth {

/// Moves that a repair has tried.
struct Trial {
  std::span<const Vec3d> before;               ///< positions that may be gone back to [m] (V)
  std::span<const IntersectingFaces> pairs;    ///< that intersect there
  std::span<const GapConstraint> constraints;  ///< which the moves were made for
  double limit = 0;                            ///< no vertex further from mesh.start [m]
  bool for_room = false;                       ///< moves pay without fewer pairs, too
};

/// Takes moves back that do not pay. Moved vertices belong to one cluster where a face, a pair that
/// intersects before or after, or a constraint joins them. A cluster that has fewer pairs than
/// before stays at mesh.x, all others go back, and so does one with a vertex beyond the limit.
/// Returns the pairs that intersect at the end, of which there are no more than before.
std::vector<IntersectingFaces> keep_what_pays(RepairMesh& mesh, const Trial& trial);

std::vector<IntersectingFaces> find_intersections(const RepairMesh& mesh);

}  // namespace icloth
