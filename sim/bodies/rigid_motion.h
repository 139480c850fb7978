// Keyframed motion of a whole body.
#pragma once

#include <vector>

#include "kernels/affine.h"

namespace icloth {

/// Rigid pose at a time; between keyframes translation and rotation vector are interpolated.
struct Keyframe {
  double time = 0;    ///< [s]
  Vec3d translation;  ///< [m]
  Vec3d rotation;     ///< axis × angle [rad], about the obstacle's own origin
};

/// The pose at a time [s]. `keys` are sorted by time; at least one.
Affine rigid_pose(const std::vector<Keyframe>& keys, double time);

}  // namespace icloth
