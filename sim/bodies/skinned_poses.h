// Poses of a body that bones and morph targets move.
#pragma once

#include <memory>

#include "sim/bodies/pose_source.h"
#include "sim/bodies/rig_pose.h"

namespace icloth {

/// What the host gives to the device for one pose.
struct SkinPose {
  std::vector<Affine> bones;   ///< (bones)
  std::vector<double> morphs;  ///< weights of the morph targets (targets)
};

class SkinnedPoses final : public PoseSource {
 public:
  /// `clip`: number of a clip of the rig, whose times are in seconds. `place`: from the space of
  /// the file to that of the scene.
  SkinnedPoses(std::shared_ptr<const Rig> rig, std::size_t clip, Playback playback, Affine place);

  bool moves() const override { return playback_.moves(clip().duration); }
  void pose(double time, std::vector<Vec3d>& out) const override;
  const SkinnedPoses* skinned() const override { return this; }

  /// Bones and morph targets at a time of the scene [s].
  SkinPose skin_pose(double time) const;
  const Rig& rig() const { return *rig_; }
  const Clip& clip() const { return rig_->clips[clip_]; }

 private:
  std::shared_ptr<const Rig> rig_;
  std::size_t clip_;
  Playback playback_;
  Affine place_;
};

/// Vertex positions of a rig in a pose, written to out (V).
void skin_vertices(const Rig& rig, const SkinPose& pose, std::vector<Vec3d>& out);

/// The rig without any clip, placed.
SkinPose bind_pose(const Rig& rig, const Affine& place);

}  // namespace icloth
