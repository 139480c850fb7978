// The matrices of the viewing pipeline, by Eigen: apart from render/camera.h, which many files
// read.
#pragma once

#include <Eigen/Geometry>

#include "render/camera.h"

namespace icloth {

/// The map from the world to a camera at `eye`, whose axes are orthonormal; it looks along −back.
Eigen::Isometry3d look(Vec3d eye, Vec3d right, Vec3d up, Vec3d back);

/// The map from the world to the camera.
Eigen::Isometry3d view_matrix(const Camera& camera);

/// The map from the camera to OpenGL's clip space. The near and far planes follow the distance to
/// the target.
Eigen::Matrix4d projection_matrix(const Camera& camera, double aspect);

}  // namespace icloth
