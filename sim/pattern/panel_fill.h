// Points inside of an outline, on a hexagonal lattice.
#pragma once

#include <span>
#include <vector>

#include "sim/files/grid_point.h"

namespace icloth {

/// Points of a hexagonal lattice with the given spacing that are inside of the ring and farther
/// from it than 0.62 spacings. Rows are level, and the lattice is symmetric about the middle of the
/// ring. The ring may turn either way; its edges are not much longer than the spacing. Row by row,
/// from below and from the left. The time is that of sorting the edges and of writing the points.
std::vector<GridPoint> fill_outline(std::span<const GridPoint> ring, double spacing);

}  // namespace icloth
