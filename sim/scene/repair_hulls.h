// The faces along a contour as two bodies: the shortest way apart of their convex hulls.
#pragma once

#include "sim/scene/repair_constraints.h"

namespace icloth {

/// For every contour of few faces the direction of the shortest translation that takes its own
/// vertices out of the convex hull of the other ones, and its length as the depth. Undecided stays
/// a contour whose faces have a vertex in common, cannot move or only touch, and what is deeper
/// than `limit` [m].
std::vector<Side> choose_hulls(const RepairMesh& mesh, std::span<const Contour> contours,
                               double limit);

/// Every vertex of the own faces ahead of every vertex of the others by `offset` [m].
std::vector<GapConstraint> keep_hulls_apart(const RepairMesh& mesh, const Contour& contour,
                                            Vec3d apart, double offset);

/// Every pair of faces of the contours that go through each other as a contour of its own, twins
/// beside each other, with the piercings of the whole contour. What only touches is left out.
std::vector<Contour> split_into_pairs(std::span<const Contour> contours);

}  // namespace icloth
