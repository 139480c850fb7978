// Shader programs from the texts in render/shaders/, which are built into the program.
#pragma once

#include <string_view>

#include "kernels/vec.h"

namespace icloth {

/// Text of render/shaders/`name`, empty when there is none.
std::string_view embedded_shader(std::string_view name);

/// A linked program of a vertex and a fragment shader. Owns it; needs a current context.
class ShaderProgram {
 public:
  /// Compiles and links. Both shaders get "#version 450 core" and lights.glsl put before them, the
  /// fragment shader shadow_lookup.glsl too. An empty fragment name makes a program that writes
  /// depth only. `draft` defines DRAFT, which leaves out the parts that software rendering is slow
  /// at. Throws DeviceError with the compiler's message.
  ShaderProgram(std::string_view vertex, std::string_view fragment, bool draft = false);
  ~ShaderProgram();
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;

  void use() const;
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, Vec3f value) const;
  void set_matrix(const char* uniform, const float* column_major) const;

 private:
  int location(const char* uniform) const;

  unsigned program_ = 0;
};

}  // namespace icloth
