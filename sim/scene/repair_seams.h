// Borders that lie beside each other and cross like teeth part along the surfaces.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/repair_constraints.h"

namespace icloth {

/// The constraints that keep two borders beside each other, at the present positions: one for each
/// vertex of one border and each edge of the other that lie side by side near the contour. Their
/// direction is the difference of the directions into the two surfaces. In a flat seam it lies in
/// the plane of the cloth, and the sharper the surfaces fold there, the more it points across them.
/// There are none where the surfaces lie on each other and not beside each other.
std::vector<GapConstraint> keep_beside(const RepairMesh& mesh, const Contour& own,
                                       const Contour& twin, double offset);

/// Marks as `in_plane` the sides of contours that run along the borders of both sheets, where the
/// borders have to move by no more than `limit` [m] to lie beside each other.
void choose_seams(const RepairMesh& mesh, std::span<const Contour> contours, double limit,
                  std::vector<Side>& sides);

}  // namespace icloth
