#include "render/shader_program.h"

#include <glad/gl.h>

#include <string>

#include "sim/files/error.h"

namespace icloth {

namespace {

constexpr GLsizei kLogLength = 2000;

/// Compiles one shader from its text and the shared texts before it.
GLuint compile(GLenum stage, std::string_view name, bool draft) {
  std::string source = "#version 450 core\n";
  if (draft) source += "#define DRAFT\n";

  // Errors are reported by the line in the shader's own file.
  source += embedded_shader("lights.glsl");
  if (stage == GL_FRAGMENT_SHADER) source += embedded_shader("shadow_lookup.glsl");
  source += "#line 1\n" + std::string(embedded_shader(name));

  const GLuint shader = glCreateShader(stage);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);

  // A shader that does not compile is reported with the compiler's message.
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  std::string log(kLogLength, '\0');
  glGetShaderInfoLog(shader, kLogLength, nullptr, log.data());
  glDeleteShader(shader);
  throw DeviceError("shader " + std::string(name) + " does not compile: " + log.c_str());
}

}  // namespace

ShaderProgram::ShaderProgram(std::string_view vertex, std::string_view fragment, bool draft) {
  const GLuint first = compile(GL_VERTEX_SHADER, vertex, draft);
  const GLuint second = fragment.empty() ? 0 : compile(GL_FRAGMENT_SHADER, fragment, draft);
  program_ = glCreateProgram();
  glAttachShader(program_, first);
  if (second) glAttachShader(program_, second);
  glLinkProgram(program_);
  glDeleteShader(first);
  if (second) glDeleteShader(second);

  // Errors between the stages show only when they are linked.
  GLint linked = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &linked);
  if (linked) return;
  std::string log(kLogLength, '\0');
  glGetProgramInfoLog(program_, kLogLength, nullptr, log.data());
  glDeleteProgram(program_);
  throw DeviceError("shader " + std::string(vertex) + " does not link: " + log.c_str());
}

ShaderProgram::~ShaderProgram() { glDeleteProgram(program_); }

void ShaderProgram::use() const { glUseProgram(program_); }

int ShaderProgram::location(const char* uniform) const {
  return glGetUniformLocation(program_, uniform);
}

void ShaderProgram::set(const char* uniform, int value) const {
  glProgramUniform1i(program_, location(uniform), value);
}

void ShaderProgram::set(const char* uniform, float value) const {
  glProgramUniform1f(program_, location(uniform), value);
}

void ShaderProgram::set(const char* uniform, Vec3f value) const {
  glProgramUniform3f(program_, location(uniform), value.x, value.y, value.z);
}

void ShaderProgram::set_matrix(const char* uniform, const float* column_major) const {
  glProgramUniformMatrix4fv(program_, location(uniform), 1, GL_FALSE, column_major);
}

}  // namespace icloth
