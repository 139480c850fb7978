// Dear ImGui between the window and the renderer's painter. The painter replaces ImGui's own OpenGL
// backend: the 1.86 of Debian loads its functions through GLX only, overruns a buffer while it does
// so, and orphans buffers in a way that some drivers get wrong.
#pragma once

#include <string>
#include <vector>

#include "app/window/window.h"
#include "render/ui_painter.h"

namespace icloth {

/// The user interface of one window.
class Ui {
 public:
  /// The window must outlive it. Font and sizes follow the window's content scale.
  explicit Ui(Window& window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  void begin_frame();
  /// Ends the frame; paint() draws it any number of times.
  void end_frame();
  void paint(int width, int height, unsigned framebuffer);

  float scale() const { return scale_; }  ///< of all sizes
  bool wants_text() const;                ///< a text field has the keyboard
  bool popup_open() const;                ///< a click anywhere belongs to the popup
  void close_popups();

 private:
  UiPainter painter_;
  std::vector<UiBatch> batches_;
  float scale_ = 1;
};

}  // namespace icloth
