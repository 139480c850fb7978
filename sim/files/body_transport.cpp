// An answer begins with the length of a JSON text [8 bytes] and the text: {"error": …} or {"bones",
// "morphs", "nodes": [name], "clips": [{"name", "in_seconds"}]}. Then follow arrays, each as its
// number of elements [8 bytes] and the elements as they are in memory: positions, faces, the arrays
// of the rig in the order of sim/bodies/rig.h, and for each clip the nodes and targets of its
// channels and their keys.
#include "sim/files/body_transport.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/files/error.h"
#include "sim/files/json_reader.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

class Encoder {
 public:
  explicit Encoder(const nlohmann::json& head) {
    const std::string text = head.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    number(text.size());
    bytes_ += text;
  }

  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    number(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }

  std::string take() { return std::move(bytes_); }

 private:
  void number(std::uint64_t value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::string bytes_;
};

/// All arrays of a rig but the clips, in the order of the answer.
template <class AnyRig, class Visit>
void visit_arrays(AnyRig& rig, const Visit& visit) {
  visit(rig.parent);
  visit(rig.local);
  visit(rig.bone_node);
  visit(rig.inverse_bind);
  visit(rig.rest);
  visit(rig.weight_first);
  visit(rig.weight_bone);
  visit(rig.weight);
  visit(rig.morph_first);
  visit(rig.morph_target);
  visit(rig.morph_delta);
  visit(rig.morph_rest);
}

void encode_clip(const Clip& clip, Encoder& to) {
  std::vector<Index> nodes, targets;
  for (const NodeChannel& channel : clip.channels) nodes.push_back(channel.node);
  for (const MorphChannel& channel : clip.morphs) targets.push_back(channel.target);
  to.array(nodes);
  to.array(targets);
  for (const NodeChannel& channel : clip.channels) {
    to.array(channel.translation);
    to.array(channel.rotation);
    to.array(channel.scale);
  }
  for (const MorphChannel& channel : clip.morphs) to.array(channel.weight);
}

constexpr double kLargestTime = 1e9;        // [s]
constexpr double kLargestWeight = 1e3;      // of a morph target
constexpr std::size_t kLongestName = 4096;  // of a node [bytes]

bool is_within(double x, double largest) { return std::abs(x) <= largest; }
bool is_fine(const Affine& map) {
  for (const double entry : map.m)
    if (!is_within(entry, kLargestCoordinate)) return false;
  return true;
}

class Decoder {
 public:
  Decoder(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

  /// `has_mesh`: whether a mesh is expected, or none.
  Body decode(bool has_mesh) {
    // The answer begins with its head, which holds an error or what is not an array.
    const std::uint64_t length = number();
    require(length <= rest_.size());
    const auto head = nlohmann::json::parse(rest_.substr(0, length), nullptr, false);
    rest_.remove_prefix(length);
    if (head.is_object() && head.contains("error") && head["error"].is_string()) {
      require(!head["error"].get_ref<const std::string&>().empty());
      throw InputError(head["error"].get<std::string>());
    }
    Body body = body_of(JsonValue(head, shown_path(path_)));

    // Each array is checked against those before it.
    array(body.mesh.positions);
    array(body.mesh.faces);
    check(body.mesh);
    require(body.mesh.faces.empty() != has_mesh);
    require(body.mesh.faces.empty() != has_mesh);
    visit_arrays(body.rig, [&](auto& values) { array(values); });
    if (body.rig.empty()) {
      require(body.rig.names.empty());
      require(body.rig.clips.empty() && body.rig.rest.empty());
    } else {
      check_nodes(body.rig);
      check_weights(body.rig, body.mesh.positions.size());
      check_morphs(body.rig);
    }
    for (Clip& clip : body.rig.clips) read_clip(body.rig, clip);
    require(rest_.empty());
    return body;
  }

  Rig decode_motion() {
    Rig motion = decode(false).rig;
    require(!motion.empty() && motion.clips.size() == 1 && motion.clips[0].in_seconds);
    return motion;
  }

 private:
  void require(bool makes_sense) const {
    if (!makes_sense)
      throw InputError(shown_path(path_) +
                       ": cannot be read: the answer of its reader makes no sense");
  }

  std::uint64_t number() {
    std::uint64_t value = 0;
    require(rest_.size() >= sizeof value);
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  /// The elements must be there before memory is taken for them.
  template <class T>
  void array(std::vector<T>& values) {
    const std::uint64_t count = number();
    require(count <= kLargestCount && count <= rest_.size() / sizeof(T));
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
  }

  Body body_of(const JsonValue& head) const {
    JsonObject object(head);
    const auto most = static_cast<std::int64_t>(kLargestCount);
    Body body;
    body.bones = static_cast<std::size_t>(object.required("bones").integer(0, most));
    body.morphs = static_cast<std::size_t>(object.required("morphs").integer(0, most));

    // Names are for pairing nodes with the joints of a motion.
    for (const JsonValue& name : object.required("nodes").items()) {
      body.rig.names.push_back(name.text());
      require(body.rig.names.back().size() <= kLongestName);
    }
    for (const JsonValue& item : object.required("clips").items()) {
      JsonObject clip(item);
      body.rig.clips.emplace_back();
      body.rig.clips.back().name = clip.required("name").text();
      body.rig.clips.back().in_seconds = clip.required("in_seconds").boolean();
    }
    return body;
  }

  void check(const TriangleMesh& mesh) const {
    for (const Vec3d& p : mesh.positions) require(is_coordinate(p));
    for (const Triangle& face : mesh.faces)
      for (const Index v : face) require_index(v, mesh.positions.size());
  }

  void require_index(Index i, std::size_t count) const {
    require(i >= 0 && static_cast<std::size_t>(i) < count);
  }

  /// Parents come before their children, so no node can be above itself.
  void check_nodes(const Rig& rig) const {
    require(rig.local.size() == rig.parent.size() && rig.names.size() == rig.parent.size());
    for (std::size_t n = 0; n < rig.parent.size(); ++n) {
      if (rig.parent[n] != kNone) require_index(rig.parent[n], n);
      require(is_fine(rig.local[n]));
    }
    require(rig.inverse_bind.size() == rig.bone_node.size());
    for (const Index node : rig.bone_node) require_index(node, rig.parent.size());
    for (const Affine& map : rig.inverse_bind) require(is_fine(map));
  }

  /// Ranges of the vertices in a list of so many elements, each within the limits.
  void check_ranges(const std::vector<Index>& first, std::size_t vertices, std::size_t elements,
                    std::size_t least, std::size_t most) const {
    require(first.size() == vertices + 1 && first.front() == 0);
    for (std::size_t v = 0; v < vertices; ++v) {
      require(first[v + 1] >= first[v]);
      const auto count = static_cast<std::size_t>(first[v + 1] - first[v]);
      require(count >= least && count <= most);
    }
    require(static_cast<std::size_t>(first.back()) == elements);
  }

  void check_weights(const Rig& rig, std::size_t vertices) const {
    require(rig.rest.size() == vertices && rig.weight.size() == rig.weight_bone.size());
    for (const Vec3d& p : rig.rest) require(is_coordinate(p));
    check_ranges(rig.weight_first, vertices, rig.weight.size(), 1, kMostWeights);
    for (std::size_t v = 0; v < vertices; ++v) {
      double sum = 0;
      for (Index w = rig.weight_first[v]; w < rig.weight_first[v + 1]; ++w) {
        const auto k = static_cast<std::size_t>(w);
        require_index(rig.weight_bone[k], rig.bone_node.size());
        require(rig.weight[k] >= 0);
        sum += rig.weight[k];
      }
      require(is_within(sum - 1, 1e-6));
    }
  }

  void check_morphs(const Rig& rig) const {
    require(rig.morph_target.size() == rig.morph_delta.size());
    for (const double weight : rig.morph_rest) require(is_within(weight, kLargestWeight));
    if (rig.morph_first.empty()) return require(rig.morph_target.empty());
    check_ranges(rig.morph_first, rig.rest.size(), rig.morph_target.size(), 0,
                 rig.morph_rest.size());
    for (const Index target : rig.morph_target) require_index(target, rig.morph_rest.size());
    for (const Vec3d& delta : rig.morph_delta) require(is_coordinate(delta));
  }

  void read_clip(const Rig& rig, Clip& clip) {
    std::vector<Index> nodes, targets;
    array(nodes);
    array(targets);

    // Each node that moves has keys of three kinds; rotations are unit quaternions.
    for (const Index node : nodes) {
      require_index(node, rig.parent.size());
      NodeChannel& channel = clip.channels.emplace_back();
      channel.node = node;
      read_keys(channel.translation, clip.duration,
                [](const VectorKey& k) { return is_coordinate(k.value); });
      read_keys(channel.rotation, clip.duration, [](const RotationKey& k) {
        return is_within(k.w * k.w + k.x * k.x + k.y * k.y + k.z * k.z - 1, 1e-6);
      });
      read_keys(channel.scale, clip.duration,
                [](const VectorKey& k) { return is_coordinate(k.value); });
    }

    // The weights of morph targets follow.
    for (const Index target : targets) {
      require_index(target, rig.morph_rest.size());
      MorphChannel& channel = clip.morphs.emplace_back();
      channel.target = target;
      read_keys(channel.weight, clip.duration,
                [](const WeightKey& k) { return is_within(k.value, kLargestWeight); });
    }
  }

  /// Keys follow each other in time; the last of all is the end of the clip.
  template <class Key, class Check>
  void read_keys(std::vector<Key>& keys, double& duration, const Check& is_fine_key) {
    array(keys);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      require(keys[k].time >= 0 && keys[k].time <= kLargestTime && is_fine_key(keys[k]));
      require(k == 0 || keys[k].time > keys[k - 1].time);
    }
    if (!keys.empty()) duration = std::max(duration, keys.back().time);
  }

  std::string_view rest_;
  const std::string& path_;
};

}  // namespace

std::string encode_error(const std::string& message) {
  const nlohmann::json head{{"error", message}};
  return Encoder(head).take();
}

std::string encode_body(const Body& body) {
  nlohmann::json head{{"bones", body.bones},
                      {"morphs", body.morphs},
                      {"nodes", body.rig.names},
                      {"clips", nlohmann::json::array()}};
  for (const Clip& clip : body.rig.clips)
    head["clips"].push_back({{"name", clip.name}, {"in_seconds", clip.in_seconds}});

  Encoder to(head);
  to.array(body.mesh.positions);
  to.array(body.mesh.faces);
  visit_arrays(body.rig, [&](const auto& values) { to.array(values); });
  for (const Clip& clip : body.rig.clips) encode_clip(clip, to);
  return to.take();
}

Body decode_body(std::string_view bytes, const std::string& path) {
  return Decoder(bytes, path).decode(true);
}

std::string encode_motion(const Rig& motion) { return encode_body({.mesh = {}, .rig = motion}); }

Rig decode_motion(std::string_view bytes, const std::string& path) {
  return Decoder(bytes, path).decode_motion();
}

}  // namespace icloth
