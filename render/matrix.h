// 4 × 4 matrices of the viewing pipeline, in double precision.
#pragma once

#include <array>

#include "kernels/vec.h"

namespace icloth {

/// A matrix in column-major order, as OpenGL takes it.
using Matrix4 = std::array<double, 16>;

inline Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
  Matrix4 c{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k) c[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return c;
}

/// The matrix from the world to a camera: its rows are the camera's axes, which look along −back.
inline Matrix4 look(Vec3d eye, Vec3d right, Vec3d up, Vec3d back) {
  return {right.x, up.x, back.x, 0, right.y,          up.y,          back.y,          0,
          right.z, up.z, back.z, 0, -dot(right, eye), -dot(up, eye), -dot(back, eye), 1};
}

/// The matrix from a camera to clip space without perspective: x and y in ±half, depth near … far
/// before the eye.
inline Matrix4 orthographic(double half, double near_plane, double far_plane) {
  const double range = far_plane - near_plane;
  return {1 / half,   0, 0, 0, 0,
          1 / half,   0, 0, 0, 0,
          -2 / range, 0, 0, 0, -(far_plane + near_plane) / range,
          1};
}

/// Moves everything in clip space by (x, y) in units of half the picture.
inline Matrix4 shifted(Matrix4 projection, double x, double y) {
  for (std::size_t column = 0; column < 4; ++column) {
    projection[4 * column] += x * projection[4 * column + 3];
    projection[4 * column + 1] += y * projection[4 * column + 3];
  }
  return projection;
}

}  // namespace icloth
