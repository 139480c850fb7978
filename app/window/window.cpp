#include "app/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>

#include "app/window/bindings.h"
#include "sim/files/error.h"

namespace icloth {

namespace {

static_assert(key::kSpace == GLFW_KEY_SPACE && key::kPeriod == GLFW_KEY_PERIOD);
static_assert(key::kEscape == GLFW_KEY_ESCAPE && key::kEnter == GLFW_KEY_ENTER);
static_assert(key::kTab == GLFW_KEY_TAB && key::kRight == GLFW_KEY_RIGHT);
static_assert(key::kLeft == GLFW_KEY_LEFT && key::kHome == GLFW_KEY_HOME);
static_assert(key::kF5 == GLFW_KEY_F5 && key::kF9 == GLFW_KEY_F9 && key::kF25 == GLFW_KEY_F25);
static_assert(key::kF1 == GLFW_KEY_F1 && key::kF11 == GLFW_KEY_F11 && key::kF12 == GLFW_KEY_F12);
static_assert(key::kKeypadEnter == GLFW_KEY_KP_ENTER && 'A' == GLFW_KEY_A && '1' == GLFW_KEY_1);
static_assert(modifier::kShift == GLFW_MOD_SHIFT && modifier::kControl == GLFW_MOD_CONTROL);
static_assert(button::kLeft == GLFW_MOUSE_BUTTON_LEFT && button::kRight == GLFW_MOUSE_BUTTON_RIGHT);
static_assert(button::kMiddle == GLFW_MOUSE_BUTTON_MIDDLE);

constexpr int kModifiers = modifier::kShift | modifier::kControl;
constexpr const char* kInstead = "`icloth run` and `icloth render` need no display";

std::string glfw_problem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

Window& self(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

/// The modifiers that are held now. They change between events of the pointer, and GLFW tells them
/// with keys and buttons only.
int modifiers_now(GLFWwindow* window) {
  const auto down = [window](int a, int b) {
    return glfwGetKey(window, a) == GLFW_PRESS || glfwGetKey(window, b) == GLFW_PRESS;
  };
  return (down(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT) ? modifier::kShift : 0) |
         (down(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL) ? modifier::kControl : 0);
}

}  // namespace

Window::Window(const std::string& title, int width, int height) {
  if (!glfwInit()) {
    throw DeviceError("no display for a window (" + glfw_problem() + "); " + kInstead);
  }

  // A core context is asked for; the scene has depth buffers of its own.
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);

  if (!window_) {
    const std::string reason = glfw_problem();
    glfwTerminate();
    throw DeviceError("no OpenGL 4.5 core context for a window (" + reason + "); " + kInstead);
  }

  glfwSetWindowSizeLimits(window_, 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSetWindowUserPointer(window_, this);

  // A context without the functions of 4.5 is of no use.
  make_current();
  try {
    load_gl(glfwGetProcAddress);
  } catch (...) {
    glfwDestroyWindow(window_);
    glfwTerminate();
    throw;
  }

  // Frames are paced by the display, or by its refresh rate where the swap does not wait.
  glfwSwapInterval(1);
  const GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(glfwGetPrimaryMonitor()) : nullptr;
  if (mode && mode->refreshRate >= 30) frame_interval_ = 1.0 / mode->refreshRate;
  install_callbacks();
  update_size();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::make_current() { glfwMakeContextCurrent(window_); }

bool Window::should_close() const { return glfwWindowShouldClose(window_); }

void Window::request_close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::add(WindowEvent event) {
  event.x = x_;
  event.y = y_;
  event.time = last_input_ = glfwGetTime();
  events_.push_back(event);
}

/// Queues all input for poll(), with the place of the pointer.
void Window::install_callbacks() {
  using Kind = WindowEvent::Kind;
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    self(w).x_ = x;
    self(w).y_ = y;
    self(w).add({.kind = Kind::move, .modifiers = modifiers_now(w)});
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
    self(w).last_input_ = glfwGetTime();
    if (!entered) self(w).add({.kind = Kind::leave});
  });

  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    self(w).last_input_ = glfwGetTime();
    self(w).dropped_.assign(paths, paths + count);
  });

  // What was covered by another window has to be shown again.
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w).last_input_ = glfwGetTime(); });

  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int code, int action, int modifiers) {
    self(w).add({.kind = action == GLFW_PRESS ? Kind::press : Kind::release,
                 .code = code,
                 .modifiers = modifiers & kModifiers});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double dy) {
    self(w).add({.kind = Kind::wheel, .modifiers = modifiers_now(w), .amount = dy});
  });

  // A key that is held repeats as presses do.
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int code, int, int action, int modifiers) {
    self(w).last_input_ = glfwGetTime();
    if (action == GLFW_RELEASE) return;
    self(w).add({.kind = Kind::key, .code = code, .modifiers = modifiers & kModifiers});
  });
}

std::vector<WindowEvent> Window::poll(double seconds) {
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  update_size();
  return std::exchange(events_, {});
}

void Window::wake() { glfwPostEmptyEvent(); }

void Window::update_size() {
  const int wide = framebuffer_width_, high = framebuffer_height_;
  glfwGetWindowSize(window_, &width_, &height_);
  glfwGetFramebufferSize(window_, &framebuffer_width_, &framebuffer_height_);
  if (framebuffer_width_ != wide || framebuffer_height_ != high) last_input_ = glfwGetTime();
}

bool Window::minimised() const {
  return framebuffer_width_ < 8 || framebuffer_height_ < 8 ||
         glfwGetWindowAttrib(window_, GLFW_ICONIFIED);
}

void Window::hide() {
  glfwHideWindow(window_);
  glfwPollEvents();
}

/// Shows the frame. Without a display behind it (virtual screens) the swap does not wait, so the
/// clock does.
void Window::show() {
  glfwSwapBuffers(window_);
  const double now = last_swap_ = glfwGetTime();
  if (now < next_frame_) {
    std::this_thread::sleep_for(std::chrono::duration<double>(next_frame_ - now));
  }
  next_frame_ = std::max(next_frame_ + frame_interval_, glfwGetTime() + 0.5 * frame_interval_);
}

void Window::toggle_full_screen() {
  // The window goes back to its old place.
  if (glfwGetWindowMonitor(window_)) {
    glfwSetWindowMonitor(window_, nullptr, restore_[0], restore_[1], restore_[2], restore_[3], 0);
    return;
  }

  // The place is kept before the window covers the monitor.
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  glfwGetWindowPos(window_, &restore_[0], &restore_[1]);
  glfwGetWindowSize(window_, &restore_[2], &restore_[3]);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

float Window::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(std::max(x, y), 0.75f, 4.0f);
}

double Window::seconds() const { return glfwGetTime(); }

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(window_);
  return text ? text : "";
}

}  // namespace icloth
