// Whether the border of a polygon crosses itself.
#pragma once

#include <span>

#include "sim/files/grid_point.h"

namespace icloth {

/// True where two edges of the closed ring of points cross in their interior. Edges that only touch
/// each other or lie on each other do not. A line sweeps over the edges from left to right, and
/// only neighbours on it are compared (Shamos and Hoey 1976), so the time is n log n.
bool crosses_itself(std::span<const GridPoint> ring);

}  // namespace icloth
