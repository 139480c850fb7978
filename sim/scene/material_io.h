// Fabrics from JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/scene/material.h"

namespace icloth {

/// Material from a JSON object; `where` is its place for messages. Keys: see docs/scene-format.md.
/// Files named in it are looked for in `folder`. Throws InputError, also where the stretching of an
/// orthotropic fabric is not positive definite.
Material parse_material(const nlohmann::json& json, const std::string& where,
                        const std::string& folder);

/// Material by name (assets/materials/NAME.json) or from a .json file, looked for in `folder`
/// first. Throws InputError; an unknown name lists the known ones.
Material load_material(const std::string& name, const std::string& folder);

}  // namespace icloth
