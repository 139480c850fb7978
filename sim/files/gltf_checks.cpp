#include "sim/files/gltf_checks.h"

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/json_reader.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMostBytes = std::int64_t{1} << 40;
constexpr std::size_t kDeepest = 1000;  ///< nodes below each other

/// Arrays and members of glTF's root, with defaults; unknown keys are none of our business.
class GltfChecker {
 public:
  GltfChecker(const nlohmann::json& json, std::uint64_t chunk_bytes, const std::string& path)
      : root_(json, shown_path(path)), chunk_bytes_(chunk_bytes), path_(path) {}

  void check() {
    if (!root_.json().is_object()) root_.refuse("an object in braces");
    for (const JsonValue& buffer : items("buffers")) check_buffer(buffer);
    for (const JsonValue& view : items("bufferViews")) check_view(view);
    for (const JsonValue& accessor : items("accessors")) check_accessor(accessor);
    check_nodes();
    for (const JsonValue& skin : items("skins")) check_skin(skin);
    for (const JsonValue& animation : items("animations")) check_animation(animation);
  }

 private:
  struct View {
    std::int64_t bytes, stride;
  };

  static std::optional<JsonValue> member(const JsonValue& value, const std::string& key) {
    if (!value.json().is_object()) value.refuse("an object in braces");
    const auto found = value.json().find(key);
    if (found == value.json().end()) return std::nullopt;
    return JsonValue(*found, value.where() + "." + key);
  }
  static std::int64_t number(const JsonValue& value, const std::string& key, std::int64_t fallback,
                             std::int64_t most = kMostBytes) {
    const auto found = member(value, key);
    return found ? found->integer(0, most) : fallback;
  }
  static std::string text(const JsonValue& value, const std::string& key) {
    const auto found = member(value, key);
    return found ? found->text() : "";
  }
  std::vector<JsonValue> items(const std::string& key) const {
    const auto found = root_.json().find(key);
    if (found == root_.json().end()) return {};
    return JsonValue(*found, root_.where() + ": " + key).items();
  }
  /// Number of an element of an array that has so many.
  static std::size_t index(const JsonValue& value, std::size_t count) {
    if (count == 0) value.refuse("no such key: the file has none of these");
    return static_cast<std::size_t>(value.integer(0, static_cast<std::int64_t>(count) - 1));
  }

  void check_buffer(const JsonValue& buffer) {
    const std::int64_t bytes = number(buffer, "byteLength", 0);
    const std::string uri = text(buffer, "uri");

    // The bytes are in the binary chunk, in the text of the URI, or in another file.
    std::uint64_t available = chunk_bytes_;
    if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');  // base64: four letters hold three bytes
      available = comma == std::string::npos ? 0 : (uri.size() - comma - 1) / 4 * 3;
    } else if (!uri.empty()) {
      available = regular_file_size(buffer_path(*member(buffer, "uri")));
    }

    // A buffer with no data at all is one that an extension fills.
    const bool filled = !uri.empty() || buffers_.empty();
    if (filled && static_cast<std::uint64_t>(bytes) > available + 2)
      member(buffer, "byteLength")
          ->refuse("at most the " + std::to_string(available) + " bytes that are there");
    buffers_.push_back(bytes);
  }

  /// Place of a buffer beside the file; assimp takes the name as it is written.
  std::string buffer_path(const JsonValue& uri) const {
    const std::string& name = uri.text();
    const fs::path relative = fs::path(name).lexically_normal();
    const fs::path folder = fs::path(path_).parent_path();
    const std::string path = (folder / relative).string();
    if (relative.empty() || relative.is_absolute() || *relative.begin() == ".." ||
        !lies_below(path, folder.string()))
      uri.refuse("the name of a file in the folder of the body or below it");
    return path;
  }

  void check_view(const JsonValue& view) {
    const auto buffer = member(view, "buffer");
    if (!buffer) view.refuse("a key 'buffer'");
    const std::int64_t whole = buffers_[index(*buffer, buffers_.size())];
    const std::int64_t offset = number(view, "byteOffset", 0);
    const std::int64_t bytes = number(view, "byteLength", 0);
    if (offset + bytes > whole)
      view.refuse("byteOffset and byteLength within the buffer's " + std::to_string(whole) +
                  " bytes");
    views_.push_back({bytes, number(view, "byteStride", 0, 252)});
  }

  void check_accessor(const JsonValue& accessor) {
    const std::int64_t count =
        number(accessor, "count", 0, static_cast<std::int64_t>(kLargestCount));
    elements_.push_back(count);
    const std::int64_t size = element_bytes(accessor);
    const auto view = member(accessor, "bufferView");
    if (!view) return;  // all zero, or filled by an extension

    // The last element has to end within the view. Elements may lie further apart than their size.
    const View& where = views_[index(*view, views_.size())];
    const std::int64_t stride = where.stride > 0 ? where.stride : size;
    const std::int64_t end =
        number(accessor, "byteOffset", 0) + (count > 0 ? (count - 1) * stride + size : 0);
    if (end > where.bytes)
      (member(accessor, "count") ? *member(accessor, "count") : accessor)
          .refuse("no more elements than the " + std::to_string(where.bytes) +
                  " bytes of its view hold");
  }

  /// Bytes of an element: those of a component times the components of its type.
  static std::int64_t element_bytes(const JsonValue& accessor) {
    const std::int64_t component = number(accessor, "componentType", 5126, 5130);
    const std::int64_t bytes = component <= 5121 ? 1 : component <= 5123 ? 2 : 4;
    constexpr std::pair<std::string_view, int> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3},
                                                           {"VEC4", 4},   {"MAT2", 4}, {"MAT3", 9},
                                                           {"MAT4", 16}};
    const std::string type = text(accessor, "type");
    for (const auto& [name, components] : kTypes)
      if (type == name) return bytes * components;
    return bytes;  // assimp refuses unknown types
  }

  /// Every node has one parent at most, and following the parents ends soon.
  void check_nodes() const {
    const std::vector<JsonValue> nodes = items("nodes");

    // The nodes are a forest when each of them is the child of one other node at most.
    std::vector<std::size_t> parent(nodes.size(), nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const auto children = member(nodes[n], "children");
      if (!children) continue;
      for (const JsonValue& child : children->items()) {
        std::size_t& its_parent = parent[index(child, nodes.size())];
        if (its_parent != nodes.size()) child.refuse("a node that no other node has as a child");
        its_parent = n;
      }
    }

    // depth[n] counts the nodes from the root down to n; 0 means that it is not known yet.
    std::vector<std::size_t> depth(nodes.size(), 0);

    // A walk upwards ends at the first node whose depth is known, so all walks together are short.
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      std::size_t steps = 0, at = n;
      for (; at != nodes.size() && depth[at] == 0; at = parent[at])
        if (++steps > kDeepest) nodes[n].refuse("at most 1000 nodes above it, and not itself");
      std::size_t below = at == nodes.size() ? 0 : depth[at];
      if (below + steps > kDeepest) nodes[n].refuse("at most 1000 nodes above it, and not itself");
      for (std::size_t m = n, left = steps; left > 0; m = parent[m], --left)
        depth[m] = below + left;
    }
  }

  std::size_t node_count() const {
    const auto nodes = root_.json().find("nodes");
    return nodes == root_.json().end() ? 0 : nodes->size();
  }
  /// A member that is the number of an element of an array of the root.
  void check_reference(const JsonValue& value, const std::string& key, std::size_t count) const {
    if (const auto found = member(value, key)) index(*found, count);
  }
  std::int64_t elements_of(const JsonValue& accessor) const {
    return elements_[index(accessor, elements_.size())];
  }

  /// Every joint is a node, once, and has an inverse bind matrix where there are any.
  void check_skin(const JsonValue& skin) const {
    const auto joints = member(skin, "joints");
    if (!joints) skin.refuse("a key 'joints'");

    // A joint that is listed twice would have two matrices.
    const std::size_t nodes = node_count();
    std::vector<bool> is_joint(nodes, false);
    std::int64_t count = 0;
    for (const JsonValue& joint : joints->items()) {
      const std::size_t node = index(joint, nodes);
      if (is_joint[node]) joint.refuse("a node that is no joint yet");
      is_joint[node] = true;
      ++count;
    }
    check_reference(skin, "skeleton", nodes);

    // Without matrices, all of them are the identity.
    const auto matrices = member(skin, "inverseBindMatrices");
    if (matrices && elements_of(*matrices) < count)
      matrices->refuse("an accessor with a matrix for each of the " + std::to_string(count) +
                       " joints");
  }

  /// Channels refer to samplers and nodes that are there, and samplers have a value for every time.
  void check_animation(const JsonValue& animation) const {
    const auto samplers = member(animation, "samplers"), channels = member(animation, "channels");

    // A cubic sampler has three values for a time, so more values than times are no mistake.
    const std::vector<JsonValue> all = samplers ? samplers->items() : std::vector<JsonValue>{};
    for (const JsonValue& sampler : all) {
      const auto input = member(sampler, "input"), output = member(sampler, "output");
      if (!input || !output) sampler.refuse("the keys 'input' and 'output'");
      const std::int64_t values = elements_of(*output);
      if (values < elements_of(*input))
        output->refuse("an accessor with a value for each of the " +
                       std::to_string(elements_of(*input)) + " times");
    }

    // A channel without a target moves nothing.
    if (!channels) return;
    for (const JsonValue& channel : channels->items()) {
      check_reference(channel, "sampler", all.size());
      if (const auto target = member(channel, "target"))
        check_reference(*target, "node", node_count());
    }
  }

  JsonValue root_;
  std::uint64_t chunk_bytes_;
  const std::string& path_;
  std::vector<std::int64_t> buffers_;  ///< [bytes]
  std::vector<View> views_;
  std::vector<std::int64_t> elements_;  ///< of the accessors
};

}  // namespace

void check_gltf(std::string_view json, std::uint64_t chunk_bytes, const std::string& path) {
  const nlohmann::json parsed = parse_json(json, shown_path(path));
  GltfChecker(parsed, chunk_bytes, path).check();
}

}  // namespace icloth
