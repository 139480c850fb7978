// Scenes from JSON files, built-in names and plain meshes.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "sim/scene.h"

namespace icloth {

/// SCENE argument of the command line: built-in name, scene JSON, or mesh file.
/// `overrides` are --set arguments "KEY=VALUE"; keys are parameters, or "triangles".
/// Throws InputError with one line: file, element, value, what was expected.
std::shared_ptr<const Scene> load_scene(const std::string& argument,
                                        std::span<const std::string> overrides);

/// Folder with scenes/ materials/ bodies/ … : $ICLOTH_ASSETS, beside the program, or the source
/// tree.
std::string assets_folder();

}  // namespace icloth
