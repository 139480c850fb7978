// Between our vectors and Eigen's, on the host. Stages, which nvcc reads as well, must not include
// this.
#pragma once

#include <Eigen/Geometry>

#include "kernels/affine.h"

namespace icloth {

inline Eigen::Vector3d to_eigen(Vec3d v) { return {v.x, v.y, v.z}; }
inline Vec3d from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// The turn by a rotation vector (axis × angle [rad]); the zero vector turns nothing.
inline Eigen::AngleAxisd angle_axis(Vec3d rotation) {
  return {norm(rotation), to_eigen(normalized(rotation))};
}

inline Affine make_affine(const Eigen::Matrix3d& linear, const Eigen::Vector3d& translation) {
  Affine a;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) a.m[4 * r + c] = linear(r, c);
    a.m[4 * r + 3] = translation[r];
  }
  return a;
}

inline Eigen::Matrix3d linear_part(const Affine& a) {
  Eigen::Matrix3d linear;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) linear(r, c) = a.m[4 * r + c];
  return linear;
}

}  // namespace icloth
