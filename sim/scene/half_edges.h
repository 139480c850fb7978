// The sides of faces, sorted so that those of one edge stand together.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

struct HalfEdge {
  std::array<Index, 2> edge{};  ///< smaller vertex first
  Index face = 0;
  Index corner = 0;  ///< the edge runs from this corner of the face to the next
};

/// All half-edges, by edge and then by face. Faces of any number may meet at an edge, therefore
/// sorting is simpler than linking pairs. `first_face`: number of the first one.
std::vector<HalfEdge> sorted_half_edges(std::span<const Triangle> faces, Index first_face = 0);

/// Those of them that are the only one of their edge: the border, by edge.
std::vector<HalfEdge> border_sides(std::span<const Triangle> faces);

}  // namespace icloth
