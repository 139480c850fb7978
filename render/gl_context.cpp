#include "render/gl_context.h"

#include <glad/gl.h>

#include <cstdio>

#include "render/cuda_vertices.h"
#include "render/gl_context_egl.h"
#include "sim/cuda_devices.h"
#include "sim/files/error.h"
#include "sim/simulator.h"

namespace icloth {

namespace {

std::string gl_text(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "unknown";
}

}  // namespace

void load_gl(GlLoader loader) {
  const int version = gladLoadGL(loader);
  if (version == 0) throw DeviceError("OpenGL: no function could be loaded, expected 4.5 core");
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    throw DeviceError("OpenGL " + std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
                      std::to_string(GLAD_VERSION_MINOR(version)) + " of " + gl_text(GL_RENDERER) +
                      ", expected 4.5 core");
  }
}

std::string gl_device_name() { return gl_text(GL_RENDERER); }

std::string gl_renderer() { return gl_text(GL_RENDERER) + ", OpenGL " + gl_text(GL_VERSION); }

bool gl_is_software() {
  const std::string renderer = gl_text(GL_RENDERER);
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

void check_gl(const char* where) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  while (glGetError() != GL_NO_ERROR) {
  }
  char code[16];
  std::snprintf(code, sizeof code, "0x%04x", error);
  throw DeviceError(std::string("OpenGL error ") + code + " in " + where);
}

std::string gl_info() {
  try {
    // A context on the device of the solver is asked for, where there is one.
    const bool cuda = build_available(Build::cuda32);
    const int device = cuda_device();
    const std::unique_ptr<GlContext> context = make_egl_context(cuda ? device : kNone);
    std::string reason;
    const std::string vertices =
        interop_works(device, reason)
            ? "CUDA-OpenGL interop (probe passed on CUDA device " + std::to_string(device) + ")"
            : "host copy (" + reason + ")";

    // The lines are those that `icloth info` prints.
    return "renderer      " + gl_renderer() + "\n              " + context->origin() +
           "\nvertices      " + vertices + "\n";
  } catch (const DeviceError& error) {
    return std::string("renderer      none: ") + error.what() + "\n";
  }
}

}  // namespace icloth
