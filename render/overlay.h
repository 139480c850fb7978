// Handles, markers and rings as triangles; sizes are in pixels, so they keep them at any distance.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/renderer.h"

namespace icloth {

struct OverlayVertex {
  Vec3f position;   ///< [m]
  float colour[4];  ///< linear, with alpha
};

/// The triangles of everything in the frame that is not cloth or body, three vertices each. Shapes
/// face the camera; lines are quads. `height` is that of the picture in pixels.
std::vector<OverlayVertex> overlay_triangles(const World& world, const Frame& frame,
                                             const Camera& camera, int height);

}  // namespace icloth
