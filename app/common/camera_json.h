// A camera as text, for the clipboard: the object that scenes hold in "cameras".
#pragma once

#include <optional>
#include <string>

#include "sim/scene/scene.h"

namespace icloth {

std::string camera_to_json(const CameraPose& pose);
/// Reads a camera; nothing when the text is none.
std::optional<CameraPose> camera_from_json(const std::string& text);

}  // namespace icloth
