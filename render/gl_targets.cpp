#include "render/gl_targets.h"

#include <glad/gl.h>

#include <string>

#include "sim/files/error.h"

namespace icloth {

namespace {

GLenum format(Target::Kind kind) {
  switch (kind) {
    case Target::Kind::sample:
      return GL_RGBA16F;
    case Target::Kind::sum:
      return GL_RGBA32F;
    case Target::Kind::shadow:
      return GL_DEPTH_COMPONENT24;
    case Target::Kind::bytes:
      break;
  }
  return GL_RGBA8;
}

/// Pixels are read one by one; a shadow map compares and blends four of them.
void set_filters(GLuint texture, bool shadow) {
  const GLint filter = shadow ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (!shadow) return;
  glTextureParameteri(texture, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(texture, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

}  // namespace

Target::~Target() { release(); }

void Target::release() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
  glDeleteRenderbuffers(1, &depth_);
  framebuffer_ = texture_ = depth_ = 0;
  width_ = height_ = 0;
}

void Target::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  release();

  // The texture has the size and the format of its kind.
  const bool shadow = kind_ == Kind::shadow;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture_);
  glTextureStorage2D(texture_, 1, format(kind_), width, height);
  set_filters(texture_, shadow);

  // The framebuffer draws into the texture, and into a depth buffer where the kind needs one.
  glCreateFramebuffers(1, &framebuffer_);
  glNamedFramebufferTexture(framebuffer_, shadow ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0,
                            texture_, 0);
  if (shadow) glNamedFramebufferDrawBuffer(framebuffer_, GL_NONE);
  if (kind_ == Kind::sample) {
    glCreateRenderbuffers(1, &depth_);
    glNamedRenderbufferStorage(depth_, GL_DEPTH_COMPONENT24, width, height);
    glNamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  }

  // A size that the driver refuses shows only now.
  if (glCheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw DeviceError("OpenGL: no framebuffer of " + std::to_string(width) + " x " +
                      std::to_string(height) + " pixels");
  }
  width_ = width;
  height_ = height;
}

void Target::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
}

void Target::bind_texture(unsigned unit) const { glBindTextureUnit(unit, texture_); }

}  // namespace icloth
