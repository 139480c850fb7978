// The nodes of a rig at a moment of a clip.
#pragma once

#include "sim/bodies/playback.h"
#include "sim/bodies/rig.h"

namespace icloth {

/// Rotation from a to b, both unit quaternions, on the shorter arc; s from 0 to 1.
RotationKey slerp(const RotationKey& a, const RotationKey& b, double s);

/// Where each node is (nodes) at a moment of the clip. Without a clip (null): in the bind pose.
std::vector<Affine> pose_nodes(const Rig& rig, const Clip* clip, PlayedMoment moment);

/// Where each bone takes the vertices that it has taken up (bones), and the weight of each morph
/// target (targets), at a moment of the clip. Without a clip (null): the bind pose.
///
/// Translations and scales are interpolated linearly between their keys, rotations by slerp. While
/// a body is blended in, each node goes from its place in the bind pose to that in the clip in the
/// same way, so that limbs keep their lengths.
void pose_rig(const Rig& rig, const Clip* clip, PlayedMoment moment, std::vector<Affine>& bones,
              std::vector<double>& morphs);

}  // namespace icloth
