// Scenes from JSON files, built-in names and plain meshes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/files/weld.h"
#include "sim/scene/scene.h"

namespace icloth {

/// What a scene may ask for: a small file must not take all memory, nor read what is not its own.
struct SceneLimits {
  Index triangles = 20'000'000;      ///< of all cloths and obstacles together
  Index body_triangles = 8'000'000;  ///< of one sphere, capsule, box, plane or funnel
  bool allow_outside = false;        ///< files below other folders than its own and assets_folder()
};

/// How the simulated vertices relate to those of the scene's files, and notes about the files.
struct SceneOrigin {
  std::vector<FileLayout> layouts;  ///< of the mesh files of the cloths (cloths)
  std::vector<std::string> notes;   ///< what the user should know about the input, a line each
};

/// SCENE argument of the command line: built-in name, scene JSON, or mesh file.
/// `overrides` are --set arguments "KEY=VALUE"; keys are parameters, "triangles" (of all grids
/// together), "clip_start" (moment at which bodies start what they play [s], in place of their own
/// "start"), "preset" and "mode" (sim/scene/presets.h), or "repair_start" (on: shallow
/// intersections are separated, sim/scene/repair.h; with garments that is left to open_scene).
/// `origin` is filled where it is given. Throws InputError with one line: file, element, value,
/// what was expected.
std::shared_ptr<const Scene> load_scene(const std::string& argument,
                                        std::span<const std::string> overrides,
                                        const SceneLimits& limits = {},
                                        SceneOrigin* origin = nullptr);

/// Median of the edges of all cloths at rest [m], since those of a stretched or bent start have
/// other lengths; 0 without cloths.
double median_edge(const Scene& scene);

/// Lowers the contact thickness and the impact offset to what the edges at rest allow: neighbours
/// repel each other in the plane above 0.3 and 0.05 edges.
void fit_thickness(Scene& scene);

}  // namespace icloth
