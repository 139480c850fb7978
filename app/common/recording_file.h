// Files of recordings among others that may be opened.
#pragma once

#include <string>

#include "sim/scene/input.h"
#include "sim/simulator.h"

namespace icloth {

/// Whether a file begins as recordings do (recording_text in sim/scene/input.h); false where it
/// cannot be read.
bool is_recording(const std::string& path);

/// The build that made a recording, on which its steps give the same bits.
Build recorded_build(const Recording& recording);

}  // namespace icloth
