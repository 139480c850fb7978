#include "sim/scene/scene.h"

#include "sim/scene/transforms.h"

namespace icloth {

void Obstacle::pose(double time, std::vector<Vec3d>& out) const {
  // Bones carry the vertices of a skinned body, with the same arithmetic as on a device.
  if (const SkinnedPoses* body = skinned()) return skin_vertices(body->rig(), skin_pose(time), out);

  // Keyframes move the whole body, whatever pose it has by itself.
  if (poses)
    poses->pose(time, out);
  else
    out = mesh.positions;
  if (motion.empty()) return;
  const Affine rigid = rigid_pose(motion, time);
  const Eigen::Matrix3d rotation = linear_part(rigid);
  const Vec3d translation{rigid.m[3], rigid.m[7], rigid.m[11]};
  for (Vec3d& p : out) p = from_eigen(rotation * to_eigen(p)) + translation;
}

SkinPose Obstacle::skin_pose(double time) const {
  SkinPose pose = skinned()->skin_pose(time);
  if (motion.empty()) return pose;
  const Affine rigid = rigid_pose(motion, time);
  for (Affine& bone : pose.bones) bone = rigid * bone;
  return pose;
}

}  // namespace icloth
