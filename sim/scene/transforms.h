// Rotations and placements of a scene's objects, on the host and by Eigen. Stages, which nvcc reads
// as well, must not include this.
#pragma once

#include <Eigen/Geometry>

#include "kernels/vec.h"

namespace icloth {

inline Eigen::Vector3d to_eigen(Vec3d v) { return {v.x, v.y, v.z}; }
inline Vec3d from_eigen(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// The turn by a rotation vector (axis × angle [rad]); the zero vector turns nothing.
inline Eigen::AngleAxisd angle_axis(Vec3d rotation) {
  return {norm(rotation), to_eigen(normalized(rotation))};
}

/// Rotation and size of an object, and where it is: x → rotation · (scale ∘ x) + translation.
/// It is no Eigen::Affine3d, since parts of it are asked for: a rest shape is only scaled.
struct Placement {
  Vec3d scale{1, 1, 1};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation{0, 0, 0};

  Vec3d operator()(Vec3d x) const {
    const Eigen::Vector3d scaled(scale.x * x.x, scale.y * x.y, scale.z * x.z);
    return from_eigen(rotation * scaled + translation);
  }
};

}  // namespace icloth
