#include "sim/files/body_rig.h"

#if defined(ICLOTH_HAS_ASSIMP)

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

Affine affine_of(const aiMatrix4x4& m) {
  return {{m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4}};
}

Vec3d vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

template <class T>
int order(T a, T b) {
  return a < b ? -1 : b < a ? 1 : 0;
}

int order(Vec3d a, Vec3d b) {
  if (const int x = order(a.x, b.x)) return x;
  if (const int y = order(a.y, b.y)) return y;
  return order(a.z, b.z);
}

/// The order of what two vertices have in two lists, in the ranges that `first` gives.
template <class Key, class Value>
int order(const std::vector<Index>& first, const std::vector<Key>& keys,
          const std::vector<Value>& values, std::size_t a, std::size_t b) {
  const Index count = first[a + 1] - first[a];
  if (const int sizes = order(count, first[b + 1] - first[b])) return sizes;
  for (Index k = 0; k < count; ++k) {
    const std::size_t i = at(first[a] + k), j = at(first[b] + k);
    if (const int key = order(keys[i], keys[j])) return key;
    if (const int value = order(values[i], values[j])) return value;
  }
  return 0;
}

/// Keeps the ranges of the vertices that are listed.
template <class Key, class Value>
void keep_ranges(const std::vector<std::size_t>& kept, std::vector<Index>& first,
                 std::vector<Key>& keys, std::vector<Value>& values) {
  std::vector<Index> new_first{0};
  std::vector<Key> new_keys;
  std::vector<Value> new_values;
  for (const std::size_t v : kept) {
    const auto begin = first[v], end = first[v + 1];
    new_keys.insert(new_keys.end(), keys.begin() + begin, keys.begin() + end);
    new_values.insert(new_values.end(), values.begin() + begin, values.begin() + end);
    new_first.push_back(static_cast<Index>(new_keys.size()));
  }
  first = std::move(new_first);
  keys = std::move(new_keys);
  values = std::move(new_values);
}

}  // namespace

RigReader::RigReader(const aiScene& scene, std::string path, bool use_morph_weights)
    : path_(std::move(path)), use_morph_weights_(use_morph_weights) {
  add_node(*scene.mRootNode, kNone);
  rig_.weight_first = {0};
  rig_.morph_first = {0};
}

/// Parents are added before their children. Bones and clips name nodes; the first of a name is
/// meant.
void RigReader::add_node(const aiNode& node, Index parent) {
  const auto number = static_cast<Index>(rig_.parent.size());
  rig_.names.emplace_back(node.mName.C_Str());
  rig_.parent.push_back(parent);
  rig_.local.push_back(affine_of(node.mTransformation));
  number_.emplace(&node, number);
  named_.emplace(node.mName.C_Str(), number);
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], number);
}

Index RigReader::node_of(const std::string& name) const {
  const auto found = named_.find(name);
  return found == named_.end() ? kNone : found->second;
}

/// The parts of a mesh repeat their bones, which are the same where node and map are.
Index RigReader::bone_of(Index node, const Affine& inverse_bind) {
  std::array<double, 12> entries;
  std::copy(std::begin(inverse_bind.m), std::end(inverse_bind.m), entries.begin());
  const auto next = static_cast<Index>(rig_.bone_node.size());
  const auto [entry, is_new] = bones_.try_emplace({node, entries}, next);
  if (is_new) {
    rig_.bone_node.push_back(node);
    rig_.inverse_bind.push_back(inverse_bind);
  }
  return entry->second;
}

/// Of each vertex of a mesh, the bones that it follows.
std::vector<std::vector<RigReader::Weight>> RigReader::weights_of(const aiMesh& mesh,
                                                                  const std::string& where) {
  std::vector<std::vector<Weight>> weights(mesh.mNumVertices);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const Index node = node_of(bone.mName.C_Str());
    if (node == kNone || bone.mNumWeights == 0) continue;
    const Index number = bone_of(node, affine_of(bone.mOffsetMatrix));
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& entry = bone.mWeights[w];
      if (!(std::abs(entry.mWeight) <= 1e6f))
        throw InputError(where + ": bone " + in_quotes(bone.mName.C_Str()) + ": vertex " +
                         std::to_string(entry.mVertexId) + ": weight: value " +
                         number_text(entry.mWeight) + ", expected a number from 0 to 1");
      if (entry.mVertexId < mesh.mNumVertices && entry.mWeight > 0)
        weights[entry.mVertexId].push_back({number, entry.mWeight});
    }
  }
  return weights;
}

/// Adds the weights of the next vertex. One that follows no bone follows its node.
void RigReader::add_weights(std::vector<Weight> weights, Index own_bone) {
  // A bone may be listed twice for a vertex.
  std::ranges::stable_sort(weights, {}, &Weight::bone);
  std::vector<Weight> sums;
  for (const Weight& w : weights) {
    if (!sums.empty() && sums.back().bone == w.bone)
      sums.back().value += w.value;
    else
      sums.push_back(w);
  }

  // The smallest of too many are dropped.
  if (sums.size() > kMostWeights) {
    std::ranges::stable_sort(sums, std::greater(), &Weight::value);
    sums.resize(kMostWeights);
    std::ranges::stable_sort(sums, {}, &Weight::bone);
  }

  if (sums.empty()) sums.push_back({own_bone, 1});
  double total = 0;
  for (const Weight& w : sums) total += w.value;
  for (const Weight& w : sums) {
    rig_.weight_bone.push_back(w.bone);
    rig_.weight.push_back(w.value / total);
  }
  rig_.weight_first.push_back(static_cast<Index>(rig_.weight.size()));
}

/// Adds how far each morph target moves the next vertex, where it moves it at all.
void RigReader::add_morphs(const aiMesh& mesh, unsigned vertex, Index first_target) {
  for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) {
    const aiAnimMesh& target = *mesh.mAnimMeshes[k];
    if (!target.mVertices || vertex >= target.mNumVertices) continue;
    const Vec3d delta = vector_of(target.mVertices[vertex]) - vector_of(mesh.mVertices[vertex]);
    if (delta == Vec3d{}) continue;
    if (!is_coordinate(delta))
      throw InputError(shown_path(path_) + ": mesh " + in_quotes(mesh.mName.C_Str()) +
                       ": morph target " + std::to_string(k) + ": vertex " +
                       std::to_string(vertex) +
                       ": value is not finite, expected three finite coordinates");
    rig_.morph_target.push_back(first_target + static_cast<Index>(k));
    rig_.morph_delta.push_back(delta);
  }
  rig_.morph_first.push_back(static_cast<Index>(rig_.morph_target.size()));
}

void RigReader::add(const aiMesh& mesh, const aiNode& node) {
  // The morph targets of each instance of a mesh have weights of their own.
  const auto first_target = static_cast<Index>(rig_.morph_rest.size());
  for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) {
    const double weight = use_morph_weights_ ? double{mesh.mAnimMeshes[k]->mWeight} : 0;
    rig_.morph_rest.push_back(std::abs(weight) <= 1e3 ? weight : 0);
  }
  instances_.push_back({node.mName.C_Str(), mesh.mName.C_Str(), first_target,
                        static_cast<Index>(mesh.mNumAnimMeshes)});

  const std::string where = shown_path(path_) + ": mesh " + in_quotes(mesh.mName.C_Str());
  const Index own_bone = bone_of(number_.at(&node), {});
  std::vector<std::vector<Weight>> weights = weights_of(mesh, where);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    rig_.rest.push_back(vector_of(mesh.mVertices[v]));
    add_weights(std::move(weights[v]), own_bone);
    add_morphs(mesh, v, first_target);
  }
}

/// An order of the vertices in which those that are equal in all ways compare as 0.
int RigReader::compare(std::size_t a, std::size_t b) const {
  if (const int place = order(rig_.rest[a], rig_.rest[b])) return place;
  if (const int w = order(rig_.weight_first, rig_.weight_bone, rig_.weight, a, b)) return w;
  return order(rig_.morph_first, rig_.morph_target, rig_.morph_delta, a, b);
}

std::vector<Index> RigReader::merge() {
  // Equal vertices become neighbours, the first of them in front.
  std::vector<std::size_t> sorted(rig_.rest.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  std::ranges::sort(sorted, [&](std::size_t a, std::size_t b) {
    const int way = compare(a, b);
    return way != 0 ? way < 0 : a < b;
  });
  std::vector<std::size_t> first_equal(sorted.size());
  for (std::size_t k = 0; k < sorted.size(); ++k)
    first_equal[sorted[k]] =
        k > 0 && compare(sorted[k - 1], sorted[k]) == 0 ? first_equal[sorted[k - 1]] : sorted[k];

  // The vertices that stay keep their order.
  std::vector<Index> number(sorted.size());
  Index next = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    number[v] = first_equal[v] == v ? next++ : number[first_equal[v]];
  keep_first(number);
  return number;
}

void RigReader::keep_first(const std::vector<Index>& number) {
  std::vector<std::size_t> kept;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == static_cast<Index>(kept.size())) kept.push_back(v);
  keep_ranges(kept, rig_.weight_first, rig_.weight_bone, rig_.weight);
  keep_ranges(kept, rig_.morph_first, rig_.morph_target, rig_.morph_delta);
  for (std::size_t k = 0; k < kept.size(); ++k) rig_.rest[k] = rig_.rest[kept[k]];
  rig_.rest.resize(kept.size());
}

Rig RigReader::take(const aiScene& scene) {
  if (rig_.morph_target.empty()) rig_.morph_first.clear();
  rig_.clips = read_clips(scene, *this, instances_, path_);
  return std::move(rig_);
}

}  // namespace icloth

#endif
