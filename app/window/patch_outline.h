// The patch of cloth that a hand holds, as lines to be drawn.
#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"
#include "sim/scene/input.h"
#include "sim/scene/world.h"

namespace icloth {

/// The line on the cloth along which a hand pulls with `share` (0…1) of its pull at the hit. A
/// patch is round in the rest shape (sim/hands.h), so that its line follows the folds; it is empty
/// where the patch is smaller than a face. `positions`: all vertices of the world [m]; 0 is the
/// rim.
std::vector<LineSegment> patch_outline(const World& world, std::span<const Vec3f> positions,
                                       const HeldHandle& handle, double share = 0);

}  // namespace icloth
