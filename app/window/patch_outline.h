// The patch of cloth that a hand holds, as lines to be drawn.
#pragma once

#include <span>
#include <vector>

#include "render/renderer.h"
#include "sim/scene/input.h"
#include "sim/scene/world.h"

namespace icloth {

/// The lines on the cloth along which a hand pulls with each of the `shares` (0…1) of its pull at
/// the hit; 0 is the rim. A patch is round in the rest shape (sim/hands.h), so that they follow the
/// folds; a line within one face has no part. `positions`: all vertices of the world [m].
std::vector<LineSegment> patch_outline(const World& world, std::span<const Vec3f> positions,
                                       const HeldHandle& handle, std::span<const double> shares);

}  // namespace icloth
