#include "render/gl_context_egl.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <numeric>
#include <string_view>

#include "render/cuda_vertices.h"
#include "sim/files/error.h"

namespace icloth {

namespace {

/// A context of EGL without a surface.
class EglContext final : public GlContext {
 public:
  EglContext(EGLDisplay display, EGLContext context, std::string origin)
      : display_(display), context_(context), origin_(std::move(origin)) {}

  // The display is not terminated: that would end other contexts of this program on it.
  ~EglContext() override {
    if (eglGetCurrentContext() == context_)
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }

  void make_current() override {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw DeviceError("EGL: the context of " + origin_ + " cannot be made current");
  }

  std::string origin() const override { return origin_; }

 private:
  EGLDisplay display_;
  EGLContext context_;
  std::string origin_;
};

/// The reasons why each attempt failed, for the message at the end.
using Tried = std::string;

template <class Function>
Function function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::string text(const char* value) { return value ? value : "unnamed"; }

/// A context of OpenGL 4.5 core, with any configuration that can do OpenGL.
EGLContext create_context(EGLDisplay display) {
  const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0)
    config = EGL_NO_CONFIG_KHR;

  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                            4,
                            EGL_CONTEXT_MINOR_VERSION,
                            5,
                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                            EGL_NONE};
  return eglCreateContext(display, config, EGL_NO_CONTEXT, version);
}

/// Makes a current context with its functions loaded, or returns nullptr and adds a reason to
/// `tried`.
std::unique_ptr<GlContext> try_display(EGLDisplay display, const std::string& name, Tried& tried) {
  const auto fail = [&](const char* why) {
    tried += (tried.empty() ? "" : "; ") + name + ": " + why;
    return nullptr;
  };

  // The display, its API and the context may each be missing.
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY) return fail("no display");
  if (!eglInitialize(display, &major, &minor)) return fail("cannot be initialised");
  if (!eglBindAPI(EGL_OPENGL_API)) return fail("OpenGL ES only");
  const EGLContext context = create_context(display);
  if (context == EGL_NO_CONTEXT) return fail("no OpenGL 4.5 core context");

  // The functions must be loaded from the driver of this very context.
  const std::string origin = name + ", " + text(eglQueryString(display, EGL_VENDOR));
  auto made = std::make_unique<EglContext>(display, context, origin);
  try {
    made->make_current();
    load_gl(&eglGetProcAddress);
  } catch (const DeviceError& error) {
    return fail(error.what());
  }
  return made;
}

/// The devices that EGL lists; none where the extension is missing.
std::vector<EGLDeviceEXT> devices() {
  const auto query = function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  EGLint count = 0;
  if (!query || !query(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> list(static_cast<std::size_t>(count));
  if (!query(count, list.data(), &count)) return {};
  list.resize(static_cast<std::size_t>(count));
  return list;
}

/// The number that EGL says CUDA gives the device, or kNone when it gives none.
int cuda_number(EGLDeviceEXT device) {
  const auto describe = function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const auto query = function<PFNEGLQUERYDEVICEATTRIBEXTPROC>("eglQueryDeviceAttribEXT");
  if (!describe || !query) return kNone;
  const char* extensions = describe(device, EGL_EXTENSIONS);
  if (!extensions ||
      std::string_view(extensions).find("EGL_NV_device_cuda") == std::string_view::npos)
    return kNone;
  EGLAttrib number = kNone;
  return query(device, EGL_CUDA_DEVICE_NV, &number) ? static_cast<int>(number) : kNone;
}

}  // namespace

std::vector<std::size_t> egl_order(std::span<const int> cuda, int wanted) {
  std::vector<std::size_t> order(cuda.size());
  std::iota(order.begin(), order.end(), std::size_t{0});

  // The wanted number ranks first, then the others that CUDA has a number for.
  const auto rank = [&](std::size_t k) { return cuda[k] < 0 ? 2 : cuda[k] == wanted ? 0 : 1; };
  if (wanted >= 0) {
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  }
  return order;
}

std::unique_ptr<GlContext> make_egl_context(int cuda_device) {
  Tried tried;
  const auto display = function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");

  // Every device of EGL is tried, those of CUDA first where vertices are to be shared with it.
  if (!display) throw DeviceError("EGL: no platform displays, expected EGL 1.5 or newer");
  const std::vector<EGLDeviceEXT> list = devices();
  std::vector<int> cuda;
  for (EGLDeviceEXT device : list) cuda.push_back(cuda_device < 0 ? kNone : cuda_number(device));

  // A context that works but draws elsewhere is kept in case that no other is found.
  std::unique_ptr<GlContext> spare;
  for (const std::size_t k : egl_order(cuda, cuda_device)) {
    const EGLDisplay platform = display(EGL_PLATFORM_DEVICE_EXT, list[k], nullptr);
    auto made = try_display(platform, "EGL device " + std::to_string(k), tried);
    if (!made) continue;
    std::string elsewhere;
    if (cuda_device < 0 || gl_runs_on_cuda(cuda_device, elsewhere)) return made;
    if (!spare) spare = std::move(made);
  }

  // The functions loaded last may be another driver's, so those of the spare context are loaded
  // again.
  if (spare) {
    spare->make_current();
    load_gl(&eglGetProcAddress);
    return spare;
  }

  // Without any device Mesa's software driver remains.
  EGLDisplay surfaceless = display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (auto made = try_display(surfaceless, "EGL surfaceless", tried)) return made;
  throw DeviceError("no OpenGL 4.5 core without a display (" + tried +
                    "), expected a GPU driver with EGL or Mesa's llvmpipe");
}

}  // namespace icloth
