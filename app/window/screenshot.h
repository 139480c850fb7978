// Pictures of the window as files.
#pragma once

#include <string>

#include "app/window/imgui_gl.h"
#include "app/window/window.h"
#include "render/gl_targets.h"

namespace icloth {

/// The first name STEM_0001.EXTENSION … of its kind in a folder that is not taken; empty: the
/// current folder. The folder is made where it is missing; throws InputError where it cannot be.
std::string free_name(const std::string& folder, const char* stem, const char* extension);

/// A sentence for the user about a file, and whether it tells of a failure.
struct SaveResult {
  std::string sentence;
  bool failed = false;
};

/// Draws the frame once more into a picture of its own, since the window on the screen may be
/// covered by other windows, and saves it in the folder. `picture` is shown from `left` to the
/// right end over `high` logical pixels; null: none.
SaveResult save_screenshot(const Window& window, Ui& ui, const Target* picture, float left,
                           float high, const std::string& folder);

}  // namespace icloth
