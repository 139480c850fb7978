// Tells on the terminal how far the dressing of a scene's garments is, and how long it took.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "sim/garment/open_scene.h"

namespace icloth {

/// A watch that shows a line with the step and the time left, and erases it when it is gone.
DressingWatch show_dressing(bool quiet);

/// open_scene with that line. Where garments were put on, and not taken from the cache, a note in
/// `origin` tells how long that took, since the statistics of a run begin after it.
std::shared_ptr<const Scene> open_scene_showing(const std::string& argument,
                                                std::span<const std::string> overrides,
                                                SceneOrigin& origin, bool quiet,
                                                const SceneLimits& limits);

}  // namespace icloth
