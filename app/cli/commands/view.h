// icloth view: the interactive window.
#pragma once

#include "app/window/view_options.h"

namespace icloth {

/// Runs the window until it is closed. Returns the exit code 0. Throws DeviceError when there is
/// no display or no OpenGL 4.5 core context, InputError when the scene cannot be loaded.
int run_view(const ViewOptions& options);

}  // namespace icloth
