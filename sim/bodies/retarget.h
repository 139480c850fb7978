// The motion of one skeleton on the body of another.
#pragma once

#include <optional>
#include <vector>

#include "sim/bodies/node_names.h"

namespace icloth {

/// What came of a motion on its way to a body.
struct Retargeted {
  Clip clip;
  double scale = 1;     ///< lengths of the body over those of the motion
  bool turned = false;  ///< the axes of the motion are others than those of the body
  double moved = 0;     ///< how far the motion started from its rest pose, taken off [of the body]
};

/// The pair whose joint is above the joints of all other pairs: the hips. None where there is none,
/// or where there are fewer than three pairs.
std::optional<NodePair> root_pair(const Rig& motion, const std::vector<NodePair>& pairs);

/// The clip of a motion for a body. `motion`: with one clip, without any turned joint in its rest
/// pose; `pairs`: in the order of the joints, with a root pair; `up`: axis of the body's file that
/// points up.
///
/// A node of a pair is turned against its own rest pose as its joint is against that of the motion,
/// both seen from outside of all bones: R(t) = Q D(t) Qᵀ A R₀, where R₀ is the rotation of the node
/// in the bind pose, D(t) that of the joint, Q takes the axes of the motion to those of the body
/// (one of the 24 turns by right angles, found by the places of the joints), and A makes up for
/// limbs that point elsewhere in the two rest poses, as arms do in T and A. A is the shortest turn
/// from the limb of the body to that of the motion, for arms and legs; a hand and its fingers have
/// that of their forearm, everything else has none.
///
/// The root is displaced from its place in the bind pose by the displacement of its joint, scaled
/// by the ratio of the heights of the two hips over the lowest of all paired joints. Files that put
/// the hips at the origin in their rest pose and into their height in the motion are recognised by
/// the first frame. Nodes without a partner keep their place against their parents.
Retargeted retarget(const Rig& motion, const Rig& body, const std::vector<NodePair>& pairs,
                    Vec3d up);

}  // namespace icloth
