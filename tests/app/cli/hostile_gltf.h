// glTF files that somebody made to break their reader. All of them are changes of one good file: a
// triangle with a skin of two joints and a clip.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace icloth {

struct HostileFile {
  std::string name;  ///< with its extension
  std::string bytes;
};

inline std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t k = 0; k < bytes; ++k) text += static_cast<char>(value >> (8 * k) & 0xff);
  return text;
}
inline std::string u16(std::uint64_t value) { return little_endian(value, 2); }
inline std::string u32(std::uint64_t value) { return little_endian(value, 4); }

inline std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t k = 0; k < times; ++k) all += text;
  return all;
}

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

/// The numbers of the good file.
struct GltfNumbers {
  std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::vector<std::uint16_t> indices = {0, 1, 2, 0};  // the last one fills up to four bytes
  std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  std::vector<float> weights = {1, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 1, 0, 0};
  std::vector<float> matrices = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::vector<float> times = {0, 1};
  std::vector<float> moves = {0, 0, 0, 0, 1, 0};
  std::vector<float> turns = {0, 0, 0, 1, 0, 0, 0.6f, 0.8f};
};

using Json = nlohmann::json;
using ChangeNumbers = std::function<void(GltfNumbers&)>;
using ChangeText = std::function<void(Json&)>;

/// Adds an accessor with a view of its own behind the data.
template <class T>
void add_accessor(Json& text, std::string& data, const std::vector<T>& values, const char* type,
                  int component, std::size_t count) {
  const std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  text["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
  text["accessors"].push_back({{"bufferView", text["bufferViews"].size() - 1},
                               {"componentType", component},
                               {"type", type},
                               {"count", count}});
  data += bytes;
}

/// Text and data of the good file with changes. The accessors are, in this order: positions,
/// indices, joints, weights, matrices, times, moves, turns. Node 0 has the mesh, 1 and 2 are the
/// joints.
inline Json make_gltf(const ChangeNumbers& change_numbers, std::string& data) {
  GltfNumbers numbers;
  if (change_numbers) change_numbers(numbers);
  Json text =
      Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"name": "hip", "children": [2]}, {"name": "knee"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3},
      "indices": 1}]}],
    "skins": [{"joints": [1, 2], "inverseBindMatrices": 4}],
    "animations": [{"name": "bend", "samplers": [{"input": 5, "output": 6}, {"input": 5,
      "output": 7}], "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
      {"sampler": 1, "target": {"node": 2, "path": "rotation"}}]}],
    "bufferViews": [], "accessors": []})");
  add_accessor(text, data, numbers.positions, "VEC3", 5126, numbers.positions.size() / 3);
  add_accessor(text, data, numbers.indices, "SCALAR", 5123, 3);
  add_accessor(text, data, numbers.joints, "VEC4", 5121, 3);
  add_accessor(text, data, numbers.weights, "VEC4", 5126, 3);
  add_accessor(text, data, numbers.matrices, "MAT4", 5126, 2);
  add_accessor(text, data, numbers.times, "SCALAR", 5126, numbers.times.size());
  add_accessor(text, data, numbers.moves, "VEC3", 5126, 2);
  add_accessor(text, data, numbers.turns, "VEC4", 5126, 2);
  text["buffers"] = {{{"byteLength", data.size()}}};
  return text;
}

/// A binary file of a JSON text and its data.
inline std::string make_glb(std::string text, std::string data) {
  text += std::string((4 - text.size() % 4) % 4, ' ');
  data += std::string((4 - data.size() % 4) % 4, '\0');
  std::string chunks = u32(text.size()) + "JSON" + text;
  if (!data.empty()) chunks += u32(data.size()) + std::string("BIN\0", 4) + data;
  return "glTF" + u32(2) + u32(12 + chunks.size()) + chunks;
}

inline std::string changed_glb(const ChangeNumbers& numbers, const ChangeText& change = {}) {
  std::string data;
  Json text = make_gltf(numbers, data);
  if (change) change(text);
  return make_glb(text.dump(), data);
}

/// Files in which numbers are broken.
inline void add_broken_numbers(std::vector<HostileFile>& files) {
  const auto add = [&](const char* name, const ChangeNumbers& change) {
    files.push_back({std::string(name) + ".glb", changed_glb(change)});
  };
  add("nan_position", [](GltfNumbers& n) { n.positions[4] = kNan; });
  add("infinite_position", [](GltfNumbers& n) { n.positions[0] = -kInf; });
  add("far_position", [](GltfNumbers& n) { n.positions[8] = 1e30f; });
  add("index_out_of_range", [](GltfNumbers& n) { n.indices[2] = 3; });
  add("largest_index", [](GltfNumbers& n) { n.indices[0] = 0xffff; });
  add("infinite_weight", [](GltfNumbers& n) { n.weights[0] = kInf; });
  add("nan_matrix", [](GltfNumbers& n) { n.matrices[20] = kNan; });
  add("infinite_matrix", [](GltfNumbers& n) { n.matrices[12] = kInf; });
  add("nan_time", [](GltfNumbers& n) { n.times[1] = kNan; });
  add("endless_time", [](GltfNumbers& n) { n.times[1] = 1e30f; });
  add("nan_move", [](GltfNumbers& n) { n.moves[1] = kNan; });
  add("infinite_move", [](GltfNumbers& n) { n.moves[5] = kInf; });
  add("turn_of_nothing", [](GltfNumbers& n) { n.turns[3] = 0; });
  add("nan_turn", [](GltfNumbers& n) { n.turns[6] = kNan; });
}

/// Files in which what is broken is left out: such weights and skins are none, and times are sorted
/// and moved to 0. The others are in order, and fly away: their numbers overflow along the nodes.
inline void add_harmless(std::vector<HostileFile>& files) {
  const auto add = [&](const char* name, const ChangeNumbers& numbers,
                       const ChangeText& change = {}) {
    files.push_back({std::string(name) + ".glb", changed_glb(numbers, change)});
  };
  add("joint_out_of_range", [](GltfNumbers& n) { n.joints[5] = 200; });
  add("nan_weight", [](GltfNumbers& n) { n.weights[4] = kNan; });
  add("negative_weight", [](GltfNumbers& n) { n.weights[5] = -0.5f; });
  add("negative_time", [](GltfNumbers& n) { n.times[0] = -1; });
  add("falling_times", [](GltfNumbers& n) { n.times = {1, 0}; });
  add("no_such_skin", {}, [](Json& t) { t["nodes"][0]["skin"] = 1; });
  add("no_joints", {}, [](Json& t) { t["skins"][0]["joints"] = Json::array(); });
  add("flies_away", [](GltfNumbers& n) { n.moves = {0, 0, 0, 9e8f, 9e8f, 9e8f}; });
  add(
      "overflows", [](GltfNumbers& n) { n.moves = {0, 0, 0, 9e8f, -9e8f, 9e8f}; },
      [](Json& t) {
        // A chain of nodes below the hip, each of which grows to the size of 900000 km.
        auto& nodes = t["nodes"];
        auto& clip = t["animations"][0];
        clip["samplers"].push_back({{"input", 5}, {"output", 6}});
        for (std::size_t n = 3; n < 50; ++n) {
          nodes.push_back({{"name", std::to_string(n)}});
          nodes[n - 1]["children"] = {n};
          clip["channels"].push_back(
              {{"sampler", 2}, {"target", {{"node", n}, {"path", "scale"}}}});
        }
        t["skins"][0]["joints"] = {1, 49};
      });
}

/// Files in which references and counts are broken.
inline void add_broken_references(std::vector<HostileFile>& files) {
  const auto add = [&](const char* name, const ChangeText& change) {
    files.push_back({std::string(name) + ".glb", changed_glb({}, change)});
  };
  add("cyclic_nodes", [](Json& t) { t["nodes"][2]["children"] = {1}; });
  add("own_child", [](Json& t) { t["nodes"][2]["children"] = {2}; });
  add("two_parents", [](Json& t) { t["nodes"][0]["children"] = {2}; });
  add("child_out_of_range", [](Json& t) { t["nodes"][2]["children"] = {77}; });
  add("no_such_mesh", [](Json& t) { t["nodes"][0]["mesh"] = 1; });
  add("no_such_scene_node", [](Json& t) { t["scenes"][0]["nodes"] = {9}; });
  add("no_such_scene", [](Json& t) { t["scene"] = 1000000; });
  add("no_such_accessor", [](Json& t) { t["meshes"][0]["primitives"][0]["indices"] = 99; });
  add("negative_accessor", [](Json& t) { t["meshes"][0]["primitives"][0]["indices"] = -1; });
  add("skin_without_joints", [](Json& t) { t["skins"][0].erase("joints"); });
  add("joint_twice", [](Json& t) { t["skins"][0]["joints"] = {1, 1}; });
  add("joint_is_no_node", [](Json& t) { t["skins"][0]["joints"] = {1, 70000}; });
  add("more_joints_than_matrices", [](Json& t) {
    for (int n = 3; n < 3000; ++n) t["nodes"].push_back({{"mesh", 0}});
    for (int n = 3; n < 3000; ++n) t["skins"][0]["joints"].push_back(n);
  });
  add("no_such_sampler", [](Json& t) { t["animations"][0]["channels"][0]["sampler"] = 5; });
  add("no_such_target", [](Json& t) { t["animations"][0]["channels"][0]["target"]["node"] = 5; });
  add("fewer_values_than_times", [](Json& t) { t["accessors"][6]["count"] = 1; });
  add("no_output", [](Json& t) { t["animations"][0]["samplers"][1].erase("output"); });
  add("huge_count", [](Json& t) { t["accessors"][0]["count"] = 4200000000u; });
  add("negative_count", [](Json& t) { t["accessors"][0]["count"] = -3; });
  add("fractional_count", [](Json& t) { t["accessors"][0]["count"] = 2.5; });
  add("count_is_text", [](Json& t) { t["accessors"][0]["count"] = "3"; });
  add("offset_wraps", [](Json& t) { t["accessors"][0]["byteOffset"] = 0xffffffffffffffdcu; });
  add("no_such_view", [](Json& t) { t["accessors"][0]["bufferView"] = 123456; });
  add("view_out_of_range", [](Json& t) { t["bufferViews"][0]["byteOffset"] = 1000000; });
  add("view_too_long", [](Json& t) { t["bufferViews"][7]["byteLength"] = 1u << 30; });
  add("view_of_no_buffer", [](Json& t) { t["bufferViews"][0]["buffer"] = 2; });
  add("huge_stride", [](Json& t) { t["bufferViews"][0]["byteStride"] = 1000000; });
  add("buffer_too_long", [](Json& t) { t["buffers"][0]["byteLength"] = 4200000000u; });
  add("short_data_uri",
      [](Json& t) { t["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAA"; });
  add("nodes_is_a_number", [](Json& t) { t["nodes"] = 3; });
  add("sparse_count", [](Json& t) {
    t["accessors"][0]["sparse"] = {{"count", 4000000000u},
                                   {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", 0}}}};
  });
  add("sparse_index", [](Json& t) {
    t["accessors"][0]["sparse"] = {{"count", 3},
                                   {"indices", {{"bufferView", 3}, {"componentType", 5125}}},
                                   {"values", {{"bufferView", 0}}}};
  });
  add("draco", [](Json& t) {
    t["extensionsRequired"] = t["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    t["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  });
}

/// Small files that grow while they are read, and others that are nested or cut.
inline void add_broken_shapes(std::vector<HostileFile>& files) {
  // Many nodes show one mesh, which has many triangles of one corner.
  std::string data;
  Json text = make_gltf({}, data);
  add_accessor(text, data, std::vector<std::uint16_t>(90000, 1), "SCALAR", 5123, 90000);
  text["meshes"][0]["primitives"][0]["indices"] = 8;
  text["buffers"][0]["byteLength"] = data.size();
  text["animations"] = Json::array();
  for (int n = 3; n < 4000; ++n) {
    text["nodes"].push_back({{"mesh", 0}});
    text["scenes"][0]["nodes"].push_back(n);
  }
  files.push_back({"instances.glb", make_glb(text.dump(), data)});

  // A chain of nodes is followed by recursion.
  Json chain = Json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}]})");
  for (int n = 0; n < 100000; ++n) chain["nodes"].push_back({{"children", {n + 1}}});
  chain["nodes"].push_back(Json::object());
  files.push_back({"chain.gltf", chain.dump()});

  // The pieces of a binary file have lengths of their own.
  const std::string good = changed_glb({});
  const auto patched = [&](std::size_t at, std::uint64_t value) {
    return std::string(good).replace(at, 4, u32(value));
  };
  files.push_back(
      {"asks_for_4_gb.glb", "glTF" + u32(2) + u32(0xffffffff) + u32(0xffffffff) + "JSON{}"});
  files.push_back({"version.glb", patched(4, 3)});
  files.push_back({"length.glb", patched(8, 100)});
  files.push_back({"chunk_length.glb", patched(12, 0x7fffffff)});
  files.push_back({"chunk_kind.glb", patched(16, 0)});
  files.push_back({"brackets.gltf", repeated("[", 200000)});
  files.push_back({"braces.glb", make_glb(repeated("{\"a\":", 200000), "")});
  files.push_back({"not_utf8.gltf", "{\"asset\": \"\xff\xfe\xc0\x80\"}"});
  files.push_back({"null.gltf", "null"});
  files.push_back({"no_version.gltf", "{}"});
}

}  // namespace icloth
