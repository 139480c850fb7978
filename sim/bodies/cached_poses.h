// Poses from a point cache.
#pragma once

#include "sim/bodies/playback.h"
#include "sim/bodies/pose_source.h"

namespace icloth {

class CachedPoses final : public PoseSource {
 public:
  /// `frames`: (frames)(V) [m], at least one. `frame_rate` [1/s]. `mesh`: positions that the body
  /// is blended in from (V).
  CachedPoses(std::vector<std::vector<Vec3f>> frames, double frame_rate, Playback playback = {},
              std::vector<Vec3d> mesh = {});

  bool moves() const override { return playback_.moves(duration()); }
  /// Straight lines between the frames.
  void pose(double time, std::vector<Vec3d>& out) const override;

  double frame_rate() const { return frame_rate_; }
  double duration() const;  ///< time of the last frame [s]

 private:
  std::vector<std::vector<Vec3f>> frames_;
  double frame_rate_;
  Playback playback_;
  std::vector<Vec3d> mesh_;
};

}  // namespace icloth
