#include "render/ui_painter.h"

#include <glad/gl.h>

#include <algorithm>
#include <cstddef>

namespace icloth {

UiPainter::UiPainter() : program_("ui.vert.glsl", "ui.frag.glsl") {
  glCreateBuffers(1, &vertices_);
  glCreateBuffers(1, &indices_);
  glCreateVertexArrays(1, &array_);
  glVertexArrayVertexBuffer(array_, 0, vertices_, 0, sizeof(UiVertex));
  glVertexArrayElementBuffer(array_, indices_);

  // The attributes are the position, the place in the font texture, and the colour.
  for (GLuint attribute : {0u, 1u, 2u}) {
    glEnableVertexArrayAttrib(array_, attribute);
    glVertexArrayAttribBinding(array_, attribute, 0);
  }
  glVertexArrayAttribFormat(array_, 0, 2, GL_FLOAT, GL_FALSE, offsetof(UiVertex, x));
  glVertexArrayAttribFormat(array_, 1, 2, GL_FLOAT, GL_FALSE, offsetof(UiVertex, u));
  glVertexArrayAttribFormat(array_, 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(UiVertex, rgba));
}

UiPainter::~UiPainter() {
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &indices_);
  glDeleteTextures(1, &font_);
}

void UiPainter::set_font(const std::uint8_t* pixels, int width, int height) {
  glDeleteTextures(1, &font_);
  glCreateTextures(GL_TEXTURE_2D, 1, &font_);
  glTextureStorage2D(font_, 1, GL_RGBA8, width, height);
  glTextureSubImage2D(font_, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  glTextureParameteri(font_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(font_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

/// The buffers get new storage every time: writing into storage that may still be drawn from has
/// been seen to go wrong on some drivers.
void UiPainter::paint(const UiDrawing& drawing, int width, int height, unsigned framebuffer) {
  if (drawing.batches.empty()) return;
  glNamedBufferData(vertices_, static_cast<GLsizeiptr>(drawing.vertices.size_bytes()),
                    drawing.vertices.data(), GL_STREAM_DRAW);
  glNamedBufferData(indices_, static_cast<GLsizeiptr>(drawing.indices.size_bytes()),
                    drawing.indices.data(), GL_STREAM_DRAW);

  // The interface is drawn over the picture, with blending and a clip rectangle for each batch.
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);

  // Positions are logical pixels, which the program turns into clip space.
  program_.use();
  program_.set("corner", Vec3f{drawing.left, drawing.top, 0});
  program_.set("size", Vec3f{drawing.width, drawing.height, 1});
  glBindTextureUnit(0, font_);
  glBindVertexArray(array_);

  // OpenGL counts clip rectangles from below.
  for (const UiBatch& batch : drawing.batches) {
    const GLint left = static_cast<GLint>(batch.clip[0]), top = static_cast<GLint>(batch.clip[1]);
    const GLint right = static_cast<GLint>(batch.clip[2]);
    const GLint bottom = static_cast<GLint>(batch.clip[3]);
    if (right <= left || bottom <= top) continue;
    glScissor(left, height - bottom, right - left, bottom - top);

    const std::uintptr_t offset = batch.first_index * sizeof(std::uint16_t);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(batch.index_count),
                             GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(offset),
                             static_cast<GLint>(batch.base_vertex));
  }

  glBindVertexArray(0);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

void clear_picture(unsigned framebuffer, float red, float green, float blue) {
  const float colour[] = {red, green, blue, 1};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glClearBufferfv(GL_COLOR, 0, colour);
}

void show_picture(const Target& picture, unsigned framebuffer, int height, int left, int top,
                  int wide, int high) {
  const bool same = wide == picture.width() && high == picture.height();
  glBlitNamedFramebuffer(picture.framebuffer(), framebuffer, 0, 0, picture.width(),
                         picture.height(), left, height - top - high, left + wide, height - top,
                         GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
}

void finish_drawing() { glFinish(); }

Image read_picture(const Target& picture) {
  Image image(picture.width(), picture.height());
  std::vector<std::uint8_t> bytes(image.pixels.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);

  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());

  // Rows are turned round, as OpenGL counts them from below, and the picture is made opaque.
  const std::size_t row = 4 * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* from = bytes.data() + static_cast<std::size_t>(image.height - 1 - y) * row;
    std::copy(from, from + row, image.at(0, y));
  }
  for (std::size_t k = 3; k < image.pixels.size(); k += 4) image.pixels[k] = 255;
  return image;
}

}  // namespace icloth
