// Which elements of a start state have to be apart, and on which side of each other.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/repair_sides.h"

namespace icloth {

/// A contour with its side, as one sheet sees it.
struct SidedContour {
  Contour contour;  ///< its twin is a number in the same list
  Side side;
};

/// Σ w_a x_a along n has to be at least `target`.
struct GapConstraint {
  std::array<Index, 4> v;
  std::array<double, 4> w;
  Vec3d n;            ///< unit
  double target = 0;  ///< [m]
};

/// The constraints at the present positions: vertices and edges of decided contours by their side
/// as deep as the contour goes, all other pairs around by the side on which they are. `offset`
/// [m] is the gap to reach; pairs that were closer than that at the start may stay so close. Once
/// nothing crosses any more (`parted`), all pairs go by the side on which they are, and those of
/// contours and of different parts count with the full offset.
std::vector<GapConstraint> collect_constraints(const RepairMesh& mesh,
                                               std::span<const SidedContour> contours,
                                               double offset, bool parted);

/// Gap of a constraint at the present positions [m].
double gap_of(const RepairMesh& mesh, const GapConstraint& constraint);

}  // namespace icloth
