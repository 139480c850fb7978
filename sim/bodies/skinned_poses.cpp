#include "sim/bodies/skinned_poses.h"

#include <utility>

namespace icloth {

SkinnedPoses::SkinnedPoses(std::shared_ptr<const Rig> rig, std::size_t clip, Playback playback,
                           Affine place)
    : rig_(std::move(rig)), clip_(clip), playback_(playback), place_(place) {}

SkinPose SkinnedPoses::skin_pose(double time) const {
  SkinPose pose;
  pose_rig(*rig_, &clip(), playback_.at(time, clip().duration), pose.bones, pose.morphs);
  for (Affine& bone : pose.bones) bone = place_ * bone;
  return pose;
}

void SkinnedPoses::pose(double time, std::vector<Vec3d>& out) const {
  skin_vertices(*rig_, skin_pose(time), out);
}

void skin_vertices(const Rig& rig, const SkinPose& pose, std::vector<Vec3d>& out) {
  const SkinArrays arrays = rig.arrays();
  out.resize(rig.rest.size());
  for (std::size_t v = 0; v < out.size(); ++v)
    out[v] = skinned_vertex(arrays, pose.bones.data(), pose.morphs.data(), static_cast<Index>(v));
}

SkinPose bind_pose(const Rig& rig, const Affine& place) {
  SkinPose pose;
  pose_rig(rig, nullptr, {}, pose.bones, pose.morphs);
  for (Affine& bone : pose.bones) bone = place * bone;
  return pose;
}

}  // namespace icloth
