// Fabrics from JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/material.h"

namespace icloth {

/// Material from a JSON object; `where` is its place for messages. Keys: name, description, source,
/// base (a material to start from), law ("measured" or "orthotropic"), density [kg/m²], damping
/// [s], stretching {rest: 4 numbers, stretched: 5 × 4 numbers} [N/m], bending: 3 × 5 numbers
/// [bending_unit × N·m]. Files named in it are looked for in `folder`. Throws InputError.
Material parse_material(const nlohmann::json& json, const std::string& where,
                        const std::string& folder);

/// Material by name (assets/materials/NAME.json) or from a .json file, looked for in `folder`
/// first. Throws InputError; an unknown name lists the known ones.
Material load_material(const std::string& name, const std::string& folder);

}  // namespace icloth
