#include "render/view_matrices.h"

#include "sim/scene/transforms.h"

namespace icloth {

Eigen::Isometry3d look(Vec3d eye, Vec3d right, Vec3d up, Vec3d back) {
  // The camera's own pose in the world, the other way round.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << to_eigen(right), to_eigen(up), to_eigen(back);
  pose.translation() = to_eigen(eye);
  return pose.inverse();
}

Eigen::Isometry3d view_matrix(const Camera& camera) {
  return look(camera.eye(), camera.right(), camera.up(), -camera.forward());
}

Eigen::Matrix4d projection_matrix(const Camera& camera, double aspect) {
  const double f = 1 / camera.half_height();

  // The planes are far enough from the target for any scene, and close enough together for the
  // precision of depth.
  const double near_plane = 0.02 * camera.distance(), far_plane = 100 * camera.distance();
  const double range = near_plane - far_plane;
  return Eigen::Matrix4d{
      {f / aspect, 0, 0, 0},
      {0, f, 0, 0},
      {0, 0, (far_plane + near_plane) / range, 2 * far_plane * near_plane / range},
      {0, 0, -1, 0}};
}

}  // namespace icloth
