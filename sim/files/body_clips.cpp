// The clips of a body file.
#include "sim/files/body_rig.h"

#if defined(ICLOTH_HAS_ASSIMP)

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

VectorKey key_of(const aiVectorKey& k) { return {k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z}}; }

bool is_sound(VectorKey& key) { return is_coordinate(key.value); }

RotationKey key_of(const aiQuatKey& k) {
  return {k.mTime, k.mValue.w, k.mValue.x, k.mValue.y, k.mValue.z};
}

/// Whether it is a rotation; files round its numbers, so it gets the length 1 again.
bool is_sound(RotationKey& key) {
  const double length = std::sqrt(key.w * key.w + key.x * key.x + key.y * key.y + key.z * key.z);
  if (!(length > 1e-6 && length < 1e6)) return false;
  for (double* part : {&key.w, &key.x, &key.y, &key.z}) *part /= length;
  return true;
}

bool is_sound(WeightKey& key) { return std::abs(key.value) <= 1e3; }

/// Reads the clip of one animation.
class ClipReader {
 public:
  ClipReader(const aiAnimation& animation, const std::string& path)
      : animation_(animation), where_(shown_path(path) + ": clip " + named(animation.mName)) {}

  Clip read(const RigReader& rig, const std::vector<MeshInstance>& instances) {
    clip_.name = animation_.mName.C_Str();
    for (unsigned c = 0; c < animation_.mNumChannels; ++c)
      add_channel(*animation_.mChannels[c], rig);
    for (unsigned c = 0; c < animation_.mNumMorphMeshChannels; ++c)
      add_morphs(*animation_.mMorphMeshChannels[c], instances);

    // Files count in ticks, whose rate not all of them give. Time 0 becomes that of the first key.
    clip_.in_seconds = std::isfinite(animation_.mTicksPerSecond) && animation_.mTicksPerSecond > 0;
    const double tick = clip_.in_seconds ? 1 / animation_.mTicksPerSecond : 1;
    const double start = first_time();
    for_each_list([&](auto& keys) {
      for (auto& key : keys) key.time = std::max(key.time - start, 0.0) * tick;
      drop_equal_times(keys);
    });
    return std::move(clip_);
  }

 private:
  static std::string named(const aiString& name) { return in_quotes(name.C_Str()); }

  void add_channel(const aiNodeAnim& channel, const RigReader& rig) {
    const Index node = rig.node_of(channel.mNodeName.C_Str());
    if (node == kNone) return;
    const std::string where = where_ + ": node " + named(channel.mNodeName);
    NodeChannel& added = clip_.channels.emplace_back();
    added.node = node;
    add_keys(channel.mPositionKeys, channel.mNumPositionKeys, where + ": translation",
             added.translation);
    add_keys(channel.mRotationKeys, channel.mNumRotationKeys, where + ": rotation", added.rotation);
    add_keys(channel.mScalingKeys, channel.mNumScalingKeys, where + ": scale", added.scale);
  }

  template <class From, class Key>
  void add_keys(const From* from, unsigned count, const std::string& where,
                std::vector<Key>& keys) const {
    keys.reserve(count);
    for (unsigned k = 0; k < count; ++k) {
      Key key = key_of(from[k]);
      check(std::abs(key.time) < 1e9 && is_sound(key), where, k);
      keys.push_back(key);
    }
    std::ranges::stable_sort(keys, {}, &Key::time);
  }

  void check(bool sound, const std::string& where, unsigned key) const {
    if (!sound)
      throw InputError(where + ": key " + std::to_string(key) +
                       ": value is not finite or no rotation, expected a time and a value");
  }

  /// The weights of the morph targets of one mesh, which share their times. The channel has the
  /// name of the node or of the mesh; some readers add a number behind an asterisk.
  void add_morphs(const aiMeshMorphAnim& channel, const std::vector<MeshInstance>& instances) {
    const std::string name = channel.mName.C_Str();
    const std::string stem = name.substr(0, name.find('*'));
    for (const MeshInstance& instance : instances) {
      if (instance.node != name && instance.mesh != name && instance.node != stem &&
          instance.mesh != stem)
        continue;
      for (Index k = 0; k < instance.targets; ++k) {
        MorphChannel& added = clip_.morphs.emplace_back();
        added.target = instance.first_target + k;
        add_weights(channel, static_cast<unsigned>(k), added.weight);
      }
    }
  }

  void add_weights(const aiMeshMorphAnim& channel, unsigned target,
                   std::vector<WeightKey>& keys) const {
    for (unsigned k = 0; k < channel.mNumKeys; ++k) {
      const aiMeshMorphKey& from = channel.mKeys[k];
      WeightKey key{from.mTime, 0};
      for (unsigned w = 0; w < from.mNumValuesAndWeights; ++w)
        if (from.mValues[w] == target) key.value = from.mWeights[w];
      check(std::abs(key.time) < 1e9 && is_sound(key),
            where_ + ": morph target " + std::to_string(target), k);
      keys.push_back(key);
    }
    std::ranges::stable_sort(keys, {}, &WeightKey::time);
  }

  template <class Visit>
  void for_each_list(const Visit& visit) {
    for (NodeChannel& channel : clip_.channels) {
      visit(channel.translation);
      visit(channel.rotation);
      visit(channel.scale);
    }
    for (MorphChannel& channel : clip_.morphs) visit(channel.weight);
  }

  /// The first key of what moves: a single key says where something is, and its time nothing.
  double first_time() {
    double first = std::numeric_limits<double>::infinity();
    for_each_list([&](const auto& keys) {
      if (keys.size() > 1) first = std::min(first, keys.front().time);
    });
    return std::isfinite(first) ? first : 0;
  }

  template <class Key>
  static void drop_equal_times(std::vector<Key>& keys) {
    if (keys.size() == 1) keys[0].time = 0;
    const auto same = [](const Key& a, const Key& b) { return a.time == b.time; };
    keys.erase(std::unique(keys.begin(), keys.end(), same), keys.end());
  }

  const aiAnimation& animation_;
  std::string where_;
  Clip clip_;
};

}  // namespace

std::vector<Clip> read_clips(const aiScene& scene, const RigReader& rig,
                             const std::vector<MeshInstance>& instances, const std::string& path) {
  std::vector<Clip> clips;
  for (unsigned i = 0; i < scene.mNumAnimations; ++i)
    clips.push_back(ClipReader(*scene.mAnimations[i], path).read(rig, instances));
  return clips;
}

}  // namespace icloth

#endif
