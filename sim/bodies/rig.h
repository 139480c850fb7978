// What moves a body: a tree of nodes, bones with weights, morph targets and clips.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "kernels/affine.h"
#include "kernels/skinning.h"

namespace icloth {

inline constexpr std::size_t kMostWeights = 8;  ///< bones that a vertex may follow

struct VectorKey {
  double time;  ///< [s]
  Vec3d value;
};

/// Unit quaternion w + xi + yj + zk.
struct RotationKey {
  double time;  ///< [s]
  double w, x, y, z;
};

struct WeightKey {
  double time;  ///< [s]
  double value;
};

/// Motion of one node against its parent: scale, then rotation, then translation. Of what has no
/// keys, the node keeps that of its bind pose. Keys are sorted by time.
struct NodeChannel {
  Index node = 0;
  std::vector<VectorKey> translation;
  std::vector<RotationKey> rotation;
  std::vector<VectorKey> scale;
};

/// Weight of one morph target over time.
struct MorphChannel {
  Index target = 0;
  std::vector<WeightKey> weight;
};

/// A motion that a body file holds. Time 0 is that of its first key.
struct Clip {
  std::string name;     ///< as the file says, not yet fit for a message
  double duration = 0;  ///< of its last key [s]
  /// False where the file counts frames and does not say how long one is: all times are frames.
  bool in_seconds = true;
  std::vector<NodeChannel> channels;
  std::vector<MorphChannel> morphs;
};

/// Nodes and bones of a body. Without nodes the body has no rig and its mesh is all there is.
struct Rig {
  std::vector<std::string> names;    ///< as the file says, not yet fit for a message (nodes)
  std::vector<Index> parent;         ///< smaller than the node's own number, kNone: root (nodes)
  std::vector<Affine> local;         ///< against the parent in the bind pose (nodes)
  std::vector<Index> bone_node;      ///< (bones)
  std::vector<Affine> inverse_bind;  ///< from the space of `rest` to that of the node (bones)

  std::vector<Vec3d> rest;          ///< (V)
  std::vector<Index> weight_first;  ///< (V + 1)
  std::vector<Index> weight_bone;   ///< (weights)
  std::vector<double> weight;       ///< (weights)
  std::vector<Index> morph_first;   ///< (V + 1), empty without morph targets
  std::vector<Index> morph_target;  ///< (displacements)
  std::vector<Vec3d> morph_delta;   ///< (displacements)
  std::vector<double> morph_rest;   ///< weight of each target in the bind pose (targets)

  std::vector<Clip> clips;

  bool empty() const { return parent.empty(); }
  SkinArrays arrays() const {
    return {rest.data(),
            weight_first.data(),
            weight_bone.data(),
            weight.data(),
            morph_first.empty() ? nullptr : morph_first.data(),
            morph_target.data(),
            morph_delta.data()};
  }
};

}  // namespace icloth
