// The source of OpenGL: a window (GLFW, in app/), or a device alone (EGL).
#pragma once

#include <memory>
#include <string>

namespace icloth {

/// The type of function that glfwGetProcAddress and eglGetProcAddress return.
using GlFunction = void (*)();
using GlLoader = GlFunction (*)(const char* name);

/// A context of OpenGL 4.5 core that its owner keeps alive.
class GlContext {
 public:
  virtual ~GlContext() = default;

  /// Makes this the calling thread's current context.
  virtual void make_current() = 0;
  /// One line that says where the context comes from, e.g. "EGL device 0 (surfaceless)".
  virtual std::string origin() const = 0;
};

/// Fetches the functions of the current context; call it once after the context became current.
/// Throws DeviceError when the context is older than 4.5 core.
void load_gl(GlLoader loader);

/// The text "RENDERER, OpenGL VERSION" of the current context.
std::string gl_renderer();

/// The device that the current context draws on, as the driver calls it: "NVIDIA H200/PCIe/SSE2".
std::string gl_device_name();

/// True when the current context draws on the processor (llvmpipe and the like).
bool gl_is_software();

/// Throws DeviceError naming `where` when OpenGL has recorded an error since the last call.
void check_gl(const char* where);

/// Several lines for `icloth info`: renderer, version, origin, and how vertices reach the GPU and
/// why. Makes a headless context of its own; when there is none, the lines say so and nothing is
/// thrown.
std::string gl_info();

}  // namespace icloth
