// Fabrics from JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/files/assets.h"
#include "sim/scene/material.h"

namespace icloth {

/// Material from a JSON object of a scene; `where` is its place for messages. Keys: see
/// docs/scene-format.md. Files named in it are looked for in the folder of the scene, and must be
/// within the scope. Throws InputError, also where the stretching of an orthotropic fabric is not
/// positive definite.
Material parse_material(const nlohmann::json& json, const std::string& where,
                        const FileScope& scope);

/// Material that a scene names at `where`: by name (assets/materials/NAME.json) or as a .json file,
/// looked for in the folder of the scene first and within the scope. Throws InputError; an unknown
/// name lists the known ones.
Material load_material(const std::string& name, const std::string& where, const FileScope& scope);

/// Material that the user names: a file may be anywhere, looked for in `folder` first. Its bases
/// must be below its own folder, or materials by name.
Material load_material(const std::string& name, const std::string& folder);

}  // namespace icloth
