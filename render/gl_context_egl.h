// OpenGL without a display.
#pragma once

#include <memory>

#include "render/gl_context.h"

namespace icloth {

/// Makes a headless context and makes it current, functions loaded: first on the EGL devices in
/// the order the driver lists them, then on Mesa's surfaceless platform. There is no default
/// framebuffer: draw into a framebuffer of your own. Throws DeviceError when no OpenGL 4.5 core
/// context is there; the message says what was tried.
std::unique_ptr<GlContext> make_egl_context();

}  // namespace icloth
