#include "sim/bodies/rig_pose.h"

#include <cmath>

#include "sim/bodies/node_pose.h"

namespace icloth {
namespace {

using Eigen::Quaterniond, Eigen::Vector3d;

Quaterniond to_eigen(const RotationKey& r) { return {r.w, r.x, r.y, r.z}; }

/// The keys around a time: their numbers, and how far the time is from the first to the second.
template <class Key>
struct Between {
  const Key &a, &b;
  double s;
};

/// `keys`: at least one, sorted by time. Before the first and after the last, their values hold.
template <class Key>
Between<Key> keys_around(const std::vector<Key>& keys, double time) {
  const auto after = std::ranges::upper_bound(keys, time, {}, &Key::time);
  if (after == keys.begin()) return {keys.front(), keys.front(), 0};
  if (after == keys.end()) return {keys.back(), keys.back(), 0};
  const Key &a = *(after - 1), &b = *after;
  return {a, b, (time - a.time) / (b.time - a.time)};
}

Vector3d sample(const std::vector<VectorKey>& keys, double time) {
  const auto [a, b, s] = keys_around(keys, time);
  return icloth::to_eigen((1 - s) * a.value + s * b.value);
}

Quaterniond sample(const std::vector<RotationKey>& keys, double time) {
  const auto [a, b, s] = keys_around(keys, time);
  return to_eigen(slerp(a, b, s));
}

Quaterniond slerp(const Quaterniond& a, const Quaterniond& b, double s) {
  return a.slerp(s, b).normalized();
}

/// A node with a channel at a moment of its clip.
Affine pose_of(const NodeChannel& channel, const Affine& bind, PlayedMoment moment) {
  const NodePose rest = parts_of(bind);
  NodePose pose = rest;
  if (!channel.translation.empty()) pose.translation = sample(channel.translation, moment.time);
  if (!channel.rotation.empty()) pose.rotation = sample(channel.rotation, moment.time);
  if (!channel.scale.empty()) pose.scale = sample(channel.scale, moment.time);

  // At the very start of a blend the bind pose is the map of the file and not its parts.
  const double s = moment.blend;
  if (s == 0) return bind;
  if (s < 1) {
    pose.translation = (1 - s) * rest.translation + s * pose.translation;
    pose.rotation = slerp(rest.rotation, pose.rotation, s);
    pose.scale = (1 - s) * rest.scale + s * pose.scale;
  }
  return pose.affine();
}

}  // namespace

RotationKey slerp(const RotationKey& a, const RotationKey& b, double s) {
  const Quaterniond q = slerp(to_eigen(a), to_eigen(b), s);
  return {(1 - s) * a.time + s * b.time, q.w(), q.x(), q.y(), q.z()};
}

std::vector<Affine> pose_nodes(const Rig& rig, const Clip* clip, PlayedMoment moment) {
  // Each node has its place against its parent from the clip, or keeps that of the bind pose.
  std::vector<Affine> node = rig.local;
  if (clip != nullptr)
    for (const NodeChannel& channel : clip->channels) {
      const auto n = static_cast<std::size_t>(channel.node);
      node[n] = pose_of(channel, rig.local[n], moment);
    }

  // Parents have smaller numbers, so they are placed before their children.
  for (std::size_t n = 0; n < node.size(); ++n)
    if (rig.parent[n] != kNone) node[n] = node[static_cast<std::size_t>(rig.parent[n])] * node[n];
  return node;
}

void pose_rig(const Rig& rig, const Clip* clip, PlayedMoment moment, std::vector<Affine>& bones,
              std::vector<double>& morphs) {
  const std::vector<Affine> node = pose_nodes(rig, clip, moment);
  bones.clear();
  for (std::size_t b = 0; b < rig.bone_node.size(); ++b)
    bones.push_back(node[static_cast<std::size_t>(rig.bone_node[b])] * rig.inverse_bind[b]);

  morphs = rig.morph_rest;
  if (clip == nullptr) return;
  for (const MorphChannel& channel : clip->morphs) {
    if (channel.weight.empty()) continue;
    const auto [a, b, s] = keys_around(channel.weight, moment.time);
    double& weight = morphs[static_cast<std::size_t>(channel.target)];
    weight += moment.blend * ((1 - s) * a.value + s * b.value - weight);
  }
}

}  // namespace icloth
