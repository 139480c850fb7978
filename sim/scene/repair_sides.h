// On which side of each other two sheets belong that go through each other.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/contours.h"

namespace icloth {

/// A vertex on the wrong side of the other sheet.
struct WrongVertex {
  Index vertex = 0;
  Index face = 0;    ///< of the other sheet, closest to the vertex
  double depth = 0;  ///< how far it has to go back [m]
};

/// The side on which one view of a contour belongs.
struct Side {
  int sign = 0;      ///< +1: this sheet belongs above the other one, −1: below; 0: not decided
  double depth = 0;  ///< the deepest place on the wrong side [m]
  bool in_plane = false;  ///< the sheets belong beside each other (sim/scene/repair_seams.h)
  Vec3d apart;            ///< unit where the faces go apart as a whole (sim/scene/repair_hulls.h)
  std::vector<WrongVertex> wrong;

  bool decided() const { return sign != 0 || in_plane || norm2(apart) > 0; }
};

/// Decides one side for every contour (Volino and Magnenat-Thalmann 2006), by the regions that the
/// contours bound on the sheets (Baraff, Witkin and Kass 2003). A region is filled from the contour
/// over vertices on one side of the other sheet. Contours that bound a common region, and the two
/// views of a contour, are decided together, so that the smaller volume moves; out of a body is
/// always above it. A view whose regions are deeper than `limit` [m] on both sides stays undecided.
std::vector<Side> choose_sides(const RepairMesh& mesh, std::span<const Contour> contours,
                               double limit);

}  // namespace icloth
