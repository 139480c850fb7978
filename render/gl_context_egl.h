// OpenGL without a display.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kernels/parallel/platform.h"
#include "render/gl_context.h"

namespace icloth {

/// Makes a headless context and makes it current, with its functions loaded. The EGL devices come
/// first, in the order the driver lists them, then Mesa's surfaceless platform. There is no default
/// framebuffer, so callers draw into framebuffers of their own. Throws DeviceError when no OpenGL
/// 4.5 core context is there; the message says what was tried.
///
/// `cuda_device` (an ordinal, or kNone) asks for the device that CUDA calls so, for interop. When
/// no context is found to draw there, the first one that works is taken.
std::unique_ptr<GlContext> make_egl_context(int cuda_device = kNone);

/// The order in which EGL devices are tried for a CUDA device, as indices. `cuda` holds the number
/// that EGL says CUDA gives each (EGL_CUDA_DEVICE_NV; kNone for none). The wanted number comes
/// first, then the others of CUDA, then the rest. The number is a hint only, because
/// CUDA_VISIBLE_DEVICES renumbers the devices of CUDA and not those of EGL.
std::vector<std::size_t> egl_order(std::span<const int> cuda, int wanted);

}  // namespace icloth
