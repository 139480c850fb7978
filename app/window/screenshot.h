// Pictures of the window as files.
#pragma once

#include <string>

#include "app/window/imgui_gl.h"
#include "app/window/window.h"
#include "render/gl_targets.h"

namespace icloth {

/// The first name STEM_0001.EXTENSION … of its kind in a folder that is not taken; empty: the
/// current folder.
std::string free_name(const std::string& folder, const char* stem, const char* extension);

/// Draws the frame once more into a picture of its own, since the window on the screen may be
/// covered by other windows, and saves it in the folder. `picture` is shown from `left` to the
/// right end over `high` logical pixels; null: none. Returns a sentence for the user, who hears of
/// a folder that cannot be written.
std::string save_screenshot(const Window& window, Ui& ui, const Target* picture, float left,
                            float high, const std::string& folder);

}  // namespace icloth
