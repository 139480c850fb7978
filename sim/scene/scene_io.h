// Scenes from JSON files, built-in names and plain meshes.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "sim/scene/scene.h"

namespace icloth {

/// What a scene may ask for at most: a small file must not take all memory.
struct SceneLimits {
  Index triangles = 20'000'000;      ///< of all cloths and obstacles together
  Index body_triangles = 8'000'000;  ///< of one sphere, capsule, box, plane or funnel
};

/// SCENE argument of the command line: built-in name, scene JSON, or mesh file.
/// `overrides` are --set arguments "KEY=VALUE"; keys are parameters, "triangles" (of all grids
/// together), "preset" (sim/scene/presets.h), or "repair_start" (on: shallow intersections are
/// separated, sim/scene/repair.h). Throws InputError with one line: file, element, value, what was
/// expected.
std::shared_ptr<const Scene> load_scene(const std::string& argument,
                                        std::span<const std::string> overrides,
                                        const SceneLimits& limits = {});

}  // namespace icloth
