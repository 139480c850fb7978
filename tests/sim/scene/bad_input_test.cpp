// Every bad input is one line that names file, element, value and what was expected.
#include <gtest/gtest.h>

#include <functional>

#include "sim/files/body_io.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/material_io.h"
#include "sim/scene/scene_io.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

/// Message of the InputError that `load` throws; must be one line and hold all the words.
void expect_error(const std::function<void()>& load, const std::vector<std::string>& words) {
  try {
    load();
    ADD_FAILURE() << "no error, expected one with " << words.front();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 400u) << message;
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' not in: " << message;
  }
}

struct BadFile {
  const char* name;
  std::string contents;
  std::vector<std::string> words;
};

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(BadInput, BrokenObjFilesAreRefused) {
  const TemporaryFolder folder;
  const std::vector<BadFile> files = {
      {"short_v.obj", "v 0 0 0\nv 1 0\n", {"line 2", "vertex 2", "(end of line)", "three finite"}},
      {"nan.obj", "v 0 0 0\nv 1 nan 0\n", {"line 2", "vertex 2", "'nan'", "finite"}},
      {"inf.obj", "v 0 -inf 0\n", {"line 1", "vertex 1", "'-inf'", "finite"}},
      {"word.obj", "v 0 0 0x\n", {"line 1", "'0x'"}},
      {"index.obj", kCorners + "f 1 2 4\n", {"line 4", "face 1", "'4'", "from 1 to 3"}},
      {"zero.obj", kCorners + "f 0 1 2\n", {"line 4", "face 1", "'0'"}},
      {"negative.obj", kCorners + "f -4 1 2\n", {"line 4", "face 1", "'-4'"}},
      {"uv.obj", kCorners + "vt 0 0\nf 1/1 2/2 3/1\n", {"line 5", "face 1", "'2'", "vt"}},
      {"cut.obj", kCorners + "f 1 2 3\nf 1 2", {"line 5", "face 2", "2 corners", "three"}},
      {"cut_corner.obj", kCorners + "f 1 2/\n", {"line 4", "face 1", "(nothing)"}},
      {"empty.obj", "", {"0 triangles"}},
      {"points.obj", kCorners, {"0 triangles", "at least one"}},
      {"huge_number.obj", "v 0 0 1e300\n", {"line 1", "'1e300'"}},
      {"far.obj", "v 0 0 1e9\nv 0 0 1.1e9\n", {"line 2", "'1.1e9'", "finite"}},
  };
  for (const BadFile& file : files) {
    std::vector<std::string> words = file.words;
    words.emplace_back(file.name);
    const std::string path = folder.write(file.name, file.contents);
    expect_error([&] { read_mesh(path); }, words);
  }
}

TEST(BadInput, BrokenPlyFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string vertices =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n";
  const std::string both =
      vertices + "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::vector<BadFile> files = {
      {"no.ply", "plx\n", {"header", "ply"}},
      {"cut_header.ply", "ply\nformat ascii 1.0\n", {"header", "end_header"}},
      {"middle.ply", "ply\nformat binary_middle_endian 1.0\nend_header\n", {"'binary_middle_"}},
      {"type.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", {"'half'"}},
      {"count.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", {"element vertex", "'-1'"}},
      {"huge.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 500000000\nproperty double x\n"
       "property double y\nproperty double z\nend_header\n1234",
       {"element vertex", "500000000", "4 bytes"}},
      {"most.ply", "ply\nformat ascii 1.0\nelement vertex 536870913\n", {"'536870913'"}},
      {"nan.ply", both + "0 0 0 1 nan 0 0 1 0 3 0 1 2\n", {"vertex 1", "nan", "finite"}},
      {"index.ply", both + "0 0 0 1 0 0 0 1 0 3 0 1 3\n", {"face 0", "'3'", "below 3"}},
      {"short.ply", both + "0 0 0 1 0 0 0 1 0 3 0 1   ", {"face 0", "end of file"}},
      {"list.ply", both + "0 0 0 1 0 0 0 1 0 9e9 0 1 2", {"face 0", "list length"}},
      {"two.ply", both + "0 0 0 1 0 0 0 1 0 2 0 1  ", {"face 0", "2 corners"}},
      {"no_z.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0 \n",
       {"vertex 0", "three finite"}},
  };
  for (const BadFile& file : files) {
    std::vector<std::string> words = file.words;
    words.emplace_back(file.name);
    const std::string path = folder.write(file.name, file.contents);
    expect_error([&] { read_mesh(path); }, words);
  }
}

TEST(BadInput, MissingFilesAndUnknownFormatsAreRefused) {
  const TemporaryFolder folder;
  expect_error([&] { read_mesh(folder.path("none.obj")); }, {"none.obj", "no such file"});
  expect_error([&] { read_mesh(folder.path("a.stl")); }, {"a.stl", "'.stl'", ".obj or .ply"});
  expect_error([&] { load_scene(folder.path("none.json"), {}); }, {"none.json", "no such file"});
  expect_error([&] { load_scene("scraf", {}); }, {"'scraf'", "scarf", "sphere"});
  expect_error([&] { load_material("silk", ""); }, {"'silk'", "gray-interlock"});
  expect_error([&] { read_body(folder.path("none.glb")); }, {"none.glb"});
  expect_error([&] { read_body(folder.write("bad.gltf", "{")); }, {"bad.gltf"});
  std::filesystem::create_directory(folder.path("folder.obj"));
  expect_error([&] { read_mesh(folder.path("folder.obj")); }, {"folder.obj", "expected a file"});
  const std::vector<NamedMesh> nothing;
  expect_error([&] { write_obj(folder.path("none/a.obj"), nothing); }, {"none/a.obj", "written"});
}

TEST(BadInput, ClothMeshesThatCannotBeClothAreRefused) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  expect_error([&] { check_cloth_mesh(mesh, "m"); }, {"m:", "0 triangles"});
  mesh.faces = {{0, 1, 2}, {0, 1, 3}};
  expect_error([&] { check_cloth_mesh(mesh, "m"); }, {"triangle 1", "0 1 3", "area above 0"});
  mesh.faces = {{0, 1, 2}, {3, 1, 3}};
  expect_error([&] { check_cloth_mesh(mesh, "m"); }, {"triangle 1", "3 1 3", "three different"});
}

TEST(BadInput, PolygonsThatCannotBeCutAreRefused) {
  const TemporaryFolder folder;
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.1 0\nv 2 0 0\nv 3 0 0\n";
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::vector<BadFile> files = {
      {"bow.obj", square + "f 1 2 3\nf 1 3 4 5 2\n", {"line 9", "face 2", "'5 corners'", "cross"}},
      {"line.obj", square + "f 1 2 6 7\n", {"line 8", "face 1", "'4 corners'", "span an area"}},
      {"bow.ply",
       header + "0 0 0 1 0 0 0 2 0 1.5 1 0 4 0 1 2 3\n",
       {"face 0", "4 corners", "cross"}},
      {"line.ply", header + "0 0 0 1 0 0 2 0 0 3 0 0 4 0 1 2 3\n", {"face 0", "span an area"}},
  };
  for (const BadFile& file : files) {
    std::vector<std::string> words = file.words;
    words.emplace_back(file.name);
    const std::string path = folder.write(file.name, file.contents);
    expect_error([&] { read_mesh(path); }, words);
  }
}

std::string pc2(std::int32_t vertices, std::int32_t frames, std::size_t floats) {
  std::string bytes("POINTCACHE2\0\1\0\0\0", 16);
  const float times[2] = {0, 1};
  bytes.append(reinterpret_cast<const char*>(&vertices), 4);
  bytes.append(reinterpret_cast<const char*>(times), 8);
  bytes.append(reinterpret_cast<const char*>(&frames), 4);
  return bytes + std::string(4 * floats, '\0');
}

std::string mdd(std::uint32_t frames, std::uint32_t points, std::size_t floats) {
  std::string bytes;
  for (std::uint32_t count : {frames, points})
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(count >> shift & 255);
  return bytes + std::string(4 * floats, '\0');
}

/// Reads the bytes as a point cache of that many vertices.
std::function<void()> read_cache(const std::string& path, Index vertices) {
  return [path, vertices] { read_point_cache(path, vertices); };
}

TEST(BadInput, BrokenPc2PointCachesAreRefused) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& bytes, Index vertices) {
    return read_cache(folder.write("a.pc2", bytes), vertices);
  };
  expect_error(read("POINTCACHE2", 3), {"a.pc2", "11 bytes", "32"});
  expect_error(read(std::string(64, 'x'), 3), {"a.pc2", "signature"});
  expect_error(read(pc2(4, 1, 12), 3), {"header", "vertices", "4", "3"});
  expect_error(read(pc2(0, 1, 12), 0), {"header", "vertices", "0"});
  // 10 GB of positions announced in a file of 68 bytes: refused before memory is taken.
  expect_error(read(pc2(850'000'000, 1, 9), 850'000'000), {"header", "frames", "0 at most"});
  expect_error(read(pc2(3, 2'000'000'000, 9), 3), {"frames", "2000000000", "1 at most"});
  expect_error(read(pc2(3, -1, 9), 3), {"frames", "-1"});
  std::string nan = pc2(1, 1, 3);
  nan.replace(36, 4, "\xff\xff\xff\x7f");
  expect_error(read(nan, 1), {"frame 0", "vertex 0", "nan", "finite"});
  nan.replace(36, 4, "\xff\xff\x7f\x7f");  // the largest float would not survive a transform
  expect_error(read(nan, 1), {"frame 0", "vertex 0", "finite"});
}

TEST(BadInput, BrokenMddPointCachesAreRefused) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& bytes, Index vertices) {
    return read_cache(folder.write("a.mdd", bytes), vertices);
  };
  expect_error(read("", 3), {"a.mdd", "0 bytes", "8"});
  expect_error(read(mdd(1, 3, 0).substr(0, 7), 3), {"a.mdd", "7 bytes"});
  expect_error(read(mdd(1, 4, 13), 3), {"header", "points", "value 4", "3, as in the mesh"});
  expect_error(read(mdd(1, 0, 13), 0), {"header", "points", "value 0"});
  expect_error(read(mdd(0, 3, 13), 3), {"header", "frames", "value 0", "at least 1"});
  expect_error(read(mdd(0x80000000, 3, 13), 3), {"frames", "-2147483648"});
  // The last byte of the second frame is missing.
  const std::string whole = mdd(2, 3, 20);
  expect_error(read(whole.substr(0, whole.size() - 1), 3), {"frames", "value 2", "1 at most"});
  // Sizes that overflow 32 and 64 bits when they are multiplied.
  expect_error(read(mdd(0x7fffffff, 3, 13), 3), {"frames", "2147483647", "1 at most", "60 bytes"});
  expect_error(read(mdd(0x7fffffff, 0x7fffffff, 13), 0x7fffffff), {"frames", "0 at most"});
  std::string bad = mdd(2, 3, 20);
  bad.replace(12, 4, std::string("\x7f\x80\0\0", 4));
  expect_error(read(bad, 3), {"frame 1", "time", "inf", "finite"});
  bad = mdd(2, 3, 20);
  bad.replace(16 + 36 + 12 + 8, 4, "\x7f\xff\xff\xff");
  expect_error(read(bad, 3), {"a.mdd", "frame 1", "vertex 1", "nan", "finite"});
  expect_error(read_cache(folder.write("a.abc", whole), 3), {"a.abc", "'.abc'", ".pc2 or .mdd"});
  expect_error(read_cache(folder.path("none.mdd"), 3), {"none.mdd", "no such file"});
}

TEST(BadInput, MessagesAreOneLineOfBoundedLength) {
  const TemporaryFolder folder;
  expect_error([&] { read_mesh(folder.path("a\nb.obj")); }, {"a b.obj", "no such file"});
  EXPECT_EQ(std::string(InputError("\x1b[2J\x7f").what()), "?[2J?");
  const std::string accents = [] {
    std::string text;
    for (int i = 0; i < 10000; ++i) text += "é";
    return text;
  }();
  for (const char* before : {"", "x"}) {
    const std::string cut = InputError(before + accents + ", expected less").what();
    EXPECT_LT(cut.size(), 1000u);
    EXPECT_TRUE(cut.ends_with("é, expected less"));
    EXPECT_NE(cut.find("é…é"), std::string::npos) << cut;
    EXPECT_EQ(cut.find('?'), std::string::npos) << "no character is cut in two";
  }

  // Words of ordinary length, but too many of them.
  std::string words;
  for (int i = 0; i < 5000; ++i) words += "éé ";
  const std::string cut = InputError(words + "end").what();
  EXPECT_LT(cut.size(), 1000u);
  EXPECT_TRUE(cut.ends_with("éé end"));
  EXPECT_NE(cut.find(" … "), std::string::npos) << cut;
}

/// Scene whose one cloth is a grid, with more keys at the top level and in the cloth.
std::string scene(const std::string& top, const std::string& cloth = "") {
  return "{" + top + R"( "cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 20)" + cloth +
         "}]}";
}

TEST(BadInput, ScenesWithBadValuesAreRefused) {
  const TemporaryFolder folder;
  const std::string path_start = R"("input": [{"vertex": 0, "path": )";
  const std::vector<BadFile> files = {
      {"a", "{\n \"cloths\": [,]}", {"line 2", "column"}},
      {"b", scene(R"("gravty": [0, 0, 0],)"), {"'gravty'", "'gravity'"}},
      {"c", scene("", R"(, "pin": [])"), {"cloths[0]", "'pin'", "'pins'"}},
      {"d", scene(R"("time_step": -0.01,)"), {"time_step", "-0.01", "to 0.1 s"}},
      {"e", scene(R"("time_step": "fast",)"), {"time_step", "fast", "number"}},
      {"f", scene("", R"(, "material": "silk")"), {"'silk'"}},
      {"g",
       R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 0}]})",
       {"cloths[0].triangles", "value 0", "from 2"}},
      {"h",
       R"({"cloths": [{"mesh": {"grid": {"size": [1, -1]}}}]})",
       {"cloths[0].mesh.grid.size", "[1,-1]"}},
      {"i", R"({"cloths": []})", {"cloths", "at least one cloth"}},
      {"j", "{}", {"cloths", "missing"}},
      {"k", R"({"cloths": [{"mesh": "none.obj"}]})", {"none.obj", "no such file"}},
      {"l",
       scene(R"("parameters": {"proximity": {"thicknes": 1}},)"),
       {"parameters.proximity", "'proximity.thicknes'", "'proximity.thickness'"}},
      {"m", scene(R"("parameters": {"proximity.thickness": 1},)"), {"value '1", "0.05"}},
      {"n", scene(R"("parameters": {"a": {"b": {"c": 1}}},)"), {"parameters.a.b"}},
      {"o", scene("", R"(, "pins": ["top_letf"])"), {"pins[0]", "top_letf", "'top_left'"}},
      {"p", scene("", R"(, "pins": [100])"), {"pins[0]", "value 100", "from 0 to"}},
      {"q",
       scene(path_start + "[[1, 0, 0, 0], [1, 0, 0, 0]]}],"),
       {"input[0].path[1]", "time after the one before"}},
      {"r", scene(path_start + R"([[1, 0, 0, 0]], "cloth": "x"}],)"), {"input[0].cloth", "\"x\""}},
      {"s", scene(path_start + R"([[1, 0, 0, 0]], "release": 0.5}],)"), {"release", "0.5"}},
      {"t", scene(R"("cameras": [{"eye": [0, 1, 0], "target": [0, 0, 0]}],)"), {"cameras[0]"}},
      {"u",
       scene(R"("obstacles": [{"mesh": {"ball": {"radius": 1}}}],)"),
       {"obstacles[0].mesh", "'ball'"}},
      {"v",
       scene(R"("obstacles": [{"mesh": {"plane": {"size": [1e6, 1], "edge": 1e-6}}}],)"),
       {"plane", "coarser"}},
      {"w",
       scene(
           R"("obstacles": [{"mesh": {"sphere": {"radius": 1}}, "motion": [{"time": 1}, {"time": 1}]}],)"),
       {"motion[1].time"}},
      {"fine_ball",
       scene(R"("obstacles": [{"mesh": {"sphere": {"radius": 1, "triangles": 1000001}}}],)"),
       {"sphere.triangles", "value 1000001", "to 1000000"}},
      {"x", scene(R"("duration": 1e999,)"), {"1e999"}},
      {"rough",
       scene(R"("obstacles": [{"mesh": {"sphere": {"radius": 1}}, "friction": 2.5}],)"),
       {"obstacles[0].friction", "value 2.5", "from 0 to 2"}},
      {"slippery", scene("", R"(, "friction": -0.1)"), {"cloths[0].friction", "value -0.1"}},
      {"no_number", scene("", R"(, "friction": null)"), {"cloths[0].friction", "null", "number"}},
      {"thick",
       scene(R"("obstacles": [{"mesh": {"sphere": {"radius": 1}}, "thickness": 0.01}],)"),
       {"obstacles[0].thickness", "not supported"}},
      {"y", scene("", R"(, "seams": [])"), {"cloths[0].seams", "at least one seam"}},
      {"clip",
       scene(R"("obstacles": [{"mesh": {"sphere": {"radius": 1}}, "animation": "walk.bvh"}],)"),
       {"obstacles[0].animation", "walk.bvh", "a body with bones"}},
      {"cache",
       scene(R"("obstacles": [{"mesh": {"sphere": {"radius": 1}}, "animation": "walk.abc"}],)"),
       {"obstacles[0].animation", "walk.abc", ".pc2"}},
      {"z", scene("", R"(, "name": "two words")"), {"cloths[0].name", "two words", "one word"}},
      {"deep", std::string(200000, '[') + std::string(200000, ']'), {"deep.json"}},
      {"million",
       R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 20000000},
           {"mesh": {"grid": {"size": [1, 1]}}, "triangles": 20000000}]})",
       {"cloths", "40000000", "at most 20000000"}},
  };
  for (const BadFile& file : files) {
    std::vector<std::string> words = file.words;
    const std::string path = folder.write(std::string(file.name) + ".json", file.contents);
    SCOPED_TRACE(file.name);
    expect_error([&] { load_scene(path, {}); }, words);
  }
}

TEST(BadInput, ClothThatIsDividedTooOftenIsRefused) {
  const TemporaryFolder folder;
  folder.write("a.obj", kCorners + "f 1 2 3\n");
  const std::string path =
      folder.write("often.json", R"({"cloths": [{"mesh": "a.obj", "subdivide": 7}]})");
  expect_error([&] { load_scene(path, {}); }, {"cloths[0].subdivide", "value 7", "from 0 to 6"});
}

TEST(BadInput, JsonFilesAboveTheLargestSizeAreRefused) {
  // The file has a length but takes no room on the disk, and must not be read into memory.
  const TemporaryFolder folder;
  const std::string path = folder.write("large.json", "{");
  std::filesystem::resize_file(path, (std::uintmax_t{256} << 20) + 1);
  expect_error([&] { load_scene(path, {}); }, {"large.json", "268435457 bytes", "268435456"});
}

TEST(BadInput, MaterialsWithTooManyBasesAreRefused) {
  // Each file takes the next one as its base; the last one stands on a fabric that is built in.
  const TemporaryFolder folder;
  const auto name = [](int k) { return std::to_string(k) + ".json"; };
  const auto chain = [&](int length) {
    for (int k = 0; k < length; ++k) {
      const std::string base = k + 1 < length ? name(k + 1) : "gray-interlock";
      folder.write(name(k), R"({"base": ")" + base + R"("})");
    }
    return folder.path(name(0));
  };
  EXPECT_NO_THROW(load_material(chain(8), ""));
  expect_error([&] { load_material(chain(9), ""); }, {"base", "come to an end"});
}

TEST(BadInput, OverridesWithBadValuesAreRefused) {
  const auto load = [](const std::string& argument) {
    return [argument] { load_scene("sphere", std::vector<std::string>{argument}); };
  };
  expect_error(load("triangles=0"), {"triangles", "'0'", "from 2"});
  expect_error(load("triangles=1e5"), {"triangles", "'1e5'"});
  expect_error(load("thickness"), {"'thickness'", "KEY=VALUE"});
  expect_error(load("impact_zones.penalti=3"), {"impact_zones.penalti", "impact_zones.penalty"});
  expect_error(load("time_step=-1"), {"time_step", "'-1'", "to 0.1 s"});
  expect_error(load("mode=psc"), {"mode", "'psc'", "icloth, pscc, cama"});
  expect_error(load("clip_start=2"), {"clip_start", "no body of the scene plays a clip"});
  expect_error(load("clip_start=-1"), {"clip_start", "'-1'", "from 0"});
  expect_error(load("clip_start=nan"), {"clip_start", "'nan'", "from 0"});
}

TEST(BadInput, MaterialsWithBadValuesAreRefused) {
  const TemporaryFolder folder;
  const std::vector<BadFile> files = {
      {"a.json", R"({"density": 0.1})", {"a.json", "stretching", "missing"}},
      {"b.json", R"({"base": "default", "density": -1})", {"b.json: density", "value -1"}},
      {"c.json",
       R"({"base": "default", "bending": [[1, 2], [1], [2]]})",
       {"c.json: bending[0]", "[1,2]", "5 numbers"}},
      {"y.json",
       R"({"base": "default", "yarn_friction": {"bending": -1e-3}})",
       {"y.json: yarn_friction.bending", "value -0.001", "from 0"}},
      {"z.json",
       R"({"base": "default", "yarn_friction": {"shaer": 1}})",
       {"yarn_friction", "'shaer'", "'shear'"}},
      {"s.json",
       R"({"base": "default", "bending_spacing": 0})",
       {"s.json: bending_spacing", "value 0", "from 0.1"}},
      {"d.json", R"({"base": "d.json"})", {"d.json: base", "come to an end"}},
      {"e.json", R"({"base": "default", "law": "linear"})", {"law", "\"linear\"", "orthotropic"}},
      {"f.json", R"({"base": "default", "densty": 1})", {"'densty'", "'density'"}},
      {"g.json",
       R"({"base": "default", "stretching": {"rest": [0, 0, 1, 1]}})",
       {"stretching.rest", "above 0"}},
      {"h.json",
       R"({"density": 0.1, "orthotropic": {"young": [100, 900], "poisson": 0.4, "shear": 10,
           "bending": [1e-6, 1e-6]}})",
       {"h.json: orthotropic.poisson", "0.4", "0.316667"}},
      {"i.json",
       R"({"density": 0.1, "orthotropic": {"young": [100, 0], "shear": 10, "thickness": 1e-3}})",
       {"i.json: orthotropic.young", "[100,0]"}},
      {"j.json",
       R"({"density": 0.1, "orthotropic": {"young": [100, 100], "shear": 10}})",
       {"j.json: orthotropic", "bending"}},
      {"k.json",
       R"({"base": "default", "law": "measured", "orthotropic": {"young": [100, 100], "shear": 10,
           "thickness": 1e-3}})",
       {"k.json: law", "orthotropic"}},
      {"l.json",
       R"({"base": "default", "law": "orthotropic", "stretching": {"rest": [10, 9.6, 10, 5]}})",
       {"l.json", "0.95 sqrt(c11 c22)"}},
      {"m.json", R"({"base": "default", "strain_limit": -0.1})", {"m.json: strain_limit", "-0.1"}},
  };
  for (const BadFile& file : files) {
    folder.write(file.name, file.contents);
    expect_error([&] { load_material(file.name, folder.path("")); }, file.words);
  }
}

}  // namespace
}  // namespace icloth
