// Files of recordings among others that may be opened.
#pragma once

#include <string>

namespace icloth {

/// Whether a file begins as recordings do (recording_text in sim/scene/input.h); false where it
/// cannot be read.
bool is_recording(const std::string& path);

}  // namespace icloth
