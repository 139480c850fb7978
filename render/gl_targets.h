// Textures to draw into.
#pragma once

namespace icloth {

/// A texture of one mip level with a framebuffer that draws into it. Owns both; needs a current
/// context.
class Target {
 public:
  enum class Kind {
    sample,  ///< half-float colour with depth
    sum,     ///< float colour
    shadow,  ///< depth only, compared when it is read
    bytes,   ///< 8-bit colour, the finished picture
  };

  explicit Target(Kind kind) : kind_(kind) {}
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  /// Makes it this large; its content is lost when the size changes. Throws DeviceError when the
  /// driver refuses.
  void resize(int width, int height);
  /// Directs drawing into it, with the viewport over all of it.
  void bind() const;
  void bind_texture(unsigned unit) const;
  unsigned framebuffer() const { return framebuffer_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void release();

  Kind kind_;
  int width_ = 0, height_ = 0;
  unsigned framebuffer_ = 0, texture_ = 0, depth_ = 0;
};

}  // namespace icloth
