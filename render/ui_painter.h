// Painting the user interface: textured triangles in window pixels. It knows nothing of the library
// that makes them, so that OpenGL stays in render/ and the interface library in app/.
#pragma once

#include <cstdint>
#include <span>

#include "render/gl_targets.h"
#include "render/image.h"
#include "render/shader_program.h"

namespace icloth {

/// A vertex of 20 bytes, the layout that interface libraries commonly use.
struct UiVertex {
  float x, y;            ///< from the top left corner [logical pixels]
  float u, v;            ///< in the font texture
  std::uint8_t rgba[4];  ///< sRGB with straight alpha
};

/// Triangles drawn with one clip rectangle.
struct UiBatch {
  float clip[4];  ///< left, top, right, bottom [framebuffer pixels]
  std::uint32_t first_index, index_count;
  std::uint32_t base_vertex;  ///< added to every index
};

struct UiDrawing {
  std::span<const UiVertex> vertices;
  std::span<const std::uint16_t> indices;
  std::span<const UiBatch> batches;
  float left = 0, top = 0, width = 1, height = 1;  ///< logical pixels shown
};

class UiPainter {
 public:
  /// Needs a current context, here and in every call. Throws DeviceError.
  UiPainter();
  ~UiPainter();
  UiPainter(const UiPainter&) = delete;
  UiPainter& operator=(const UiPainter&) = delete;

  /// Takes the font texture as RGBA bytes, rows from the top.
  void set_font(const std::uint8_t* pixels, int width, int height);
  /// Paints over the framebuffer, whose size in pixels is `width` × `height`.
  void paint(const UiDrawing& drawing, int width, int height, unsigned framebuffer);

 private:
  ShaderProgram program_;
  unsigned array_ = 0, vertices_ = 0, indices_ = 0, font_ = 0;
};

/// Fills a framebuffer with a colour (sRGB, 0 … 1).
void clear_picture(unsigned framebuffer, float red, float green, float blue);

/// Copies a picture into a framebuffer of `height` pixels, its top left corner at (left, top),
/// stretched to `wide` × `high` pixels.
void show_picture(const Target& picture, unsigned framebuffer, int height, int left, int top,
                  int wide, int high);

/// Waits until all drawing that was asked for is done.
void finish_drawing();

/// The finished picture as an image, rows from the top.
Image read_picture(const Target& picture);

}  // namespace icloth
