// Rotations and placements of a scene's objects, on the host and by Eigen. Stages, which nvcc reads
// as well, must not include this.
#pragma once

#include "sim/bodies/eigen.h"

namespace icloth {

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
  Affine affine() const {
    return make_affine(rotation * to_eigen(scale).asDiagonal(), translation);
  }
};

}  // namespace icloth
