// Contours of intersection: the lines along which surfaces go through each other.
#pragma once

#include <span>
#include <vector>

#include "sim/scene/intersections.h"
#include "sim/scene/repair_mesh.h"

namespace icloth {

/// An edge that goes through a face.
struct Piercing {
  Index edge, face;
  Index above, below;  ///< the ends of the edge on the positive and the negative side of the face
};

/// A contour as one of its two sheets sees it. Both views exist: what is `own` in the one is
/// `other` in the other, its twin. For a contour that closes on one sheet and turns back on itself
/// they may be the same.
struct Contour {
  struct Segment {
    Index own, other;  ///< faces that cross each other
  };
  std::vector<Segment> segments;
  std::vector<Piercing> piercings;  ///< edges of this sheet through faces of the other
  std::size_t twin = 0;
};

/// Joins pairs of faces that cross to contours: two segments belong together where an edge between
/// two faces of the one sheet goes through a face of the other. The signs are exact for the stored
/// positions; a vertex that lies in a face counts as above it.
std::vector<Contour> trace_contours(const RepairMesh& mesh,
                                    std::span<const IntersectingFaces> pairs);

}  // namespace icloth
