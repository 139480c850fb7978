// The parts of a node's place against its parent, on the host.
#pragma once

#include "sim/bodies/eigen.h"

namespace icloth {

/// Scale, then rotation, then translation.
struct NodePose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();

  Affine affine() const {
    return make_affine(rotation.toRotationMatrix() * scale.asDiagonal(), translation);
  }
};

/// The parts of a map. A mirror is a negative scale of x; a map that is flat along an axis has no
/// rotation that could be found, and shear is lost.
inline NodePose parts_of(const Affine& map) {
  Eigen::Matrix3d linear = linear_part(map);
  NodePose pose;
  pose.translation = Eigen::Vector3d(map.m[3], map.m[7], map.m[11]);
  pose.scale = linear.colwise().norm();
  if (!(pose.scale.minCoeff() > 0)) return pose;
  if (linear.determinant() < 0) pose.scale.x() = -pose.scale.x();
  for (int c = 0; c < 3; ++c) linear.col(c) /= pose.scale[c];
  pose.rotation = Eigen::Quaterniond(linear).normalized();
  return pose;
}

}  // namespace icloth
