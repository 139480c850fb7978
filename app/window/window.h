// A window with an OpenGL context, and the input that it received. GLFW is used nowhere else.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/gl_context.h"

struct GLFWwindow;

namespace icloth {

/// One event, in the order in which they happened. Positions are logical window pixels from the top
/// left corner.
struct WindowEvent {
  enum class Kind { press, release, move, wheel, key, leave };
  Kind kind = Kind::move;
  int code = 0;         ///< button or key, see bindings.h
  int modifiers = 0;    ///< bits of modifier::
  double x = 0, y = 0;  ///< pointer
  double amount = 0;    ///< wheel notches, up is positive
  double time = 0;      ///< [s]
};

/// The window of the program.
class Window : public GlContext {
 public:
  /// Opens the window and makes its context current, functions loaded. Throws DeviceError when
  /// there is no display or no OpenGL 4.5 core; the message names the commands that need none.
  Window(const std::string& title, int width, int height);
  ~Window() override;

  void make_current() override;
  std::string origin() const override { return "window (GLFW)"; }

  bool should_close() const;
  void request_close();
  void hide();
  void set_title(const std::string& title);
  /// Handles the events that arrived and returns them; where there are none, waits for them, or for
  /// a wake(), up to so many seconds.
  std::vector<WindowEvent> poll(double seconds = 0);
  /// The files that were dropped onto the window since the last call.
  std::vector<std::string> take_dropped() { return std::exchange(dropped_, {}); }
  /// Ends the wait of poll(). From any thread, while the window exists.
  static void wake();
  /// When the last frame was handed over, before any wait for the display's pace [s].
  double last_swap() const { return last_swap_; }
  /// When input of any kind arrived last, or the size changed [s].
  double last_input() const { return last_input_; }
  /// Shows the frame, not more often than the display does.
  void show();
  void toggle_full_screen();

  int width() const { return width_; }  ///< logical pixels
  int height() const { return height_; }
  int framebuffer_width() const { return framebuffer_width_; }
  int framebuffer_height() const { return framebuffer_height_; }
  bool minimised() const;
  /// The scale of the display, 1 at 96 dots per inch.
  float content_scale() const;
  double seconds() const;  ///< since the window opened
  void set_clipboard(const std::string& text);
  std::string clipboard() const;
  GLFWwindow* handle() const { return window_; }

 private:
  void update_size();
  void install_callbacks();
  void add(WindowEvent event);

  GLFWwindow* window_ = nullptr;
  std::vector<WindowEvent> events_;
  std::vector<std::string> dropped_;
  double x_ = 0, y_ = 0;
  int width_ = 0, height_ = 0, framebuffer_width_ = 0, framebuffer_height_ = 0;
  int restore_[4] = {0, 0, 0, 0};                      ///< place and size before full screen
  double frame_interval_ = 1.0 / 60, next_frame_ = 0;  ///< [s]
  double last_input_ = 0, last_swap_ = 0;              ///< [s]
};

}  // namespace icloth
