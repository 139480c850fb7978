// Readers and writers of meshes and point caches.
#include "sim/files/mesh_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <sstream>

#include "sim/files/body_io.h"
#include "sim/files/error.h"
#include "sim/files/mesh_formats.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

const std::string kData = std::string(ICLOTH_TEST_FOLDER) + "/data/";

std::string outside_data() {
  const char* chosen = std::getenv("ICLOTH_DATA");
  return chosen ? chosen : ICLOTH_DATA_DEFAULT;
}

TEST(MeshIo, ObjKeepsOrderCutsFansAndNamesGroups) {
  const MeshFile file = read_mesh(kData + "groups.obj");
  ASSERT_EQ(file.mesh.positions.size(), 10u);
  EXPECT_EQ(file.mesh.positions[2], (Vec3d{1.5, 1, 0}));
  EXPECT_EQ(file.mesh.positions[3], (Vec3d{0.5, 2, 0}));
  const std::vector<Triangle> expected = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4},
                                          {1, 5, 6}, {1, 6, 2}, {7, 9, 8}};
  EXPECT_EQ(file.mesh.faces, expected);
  ASSERT_EQ(file.groups.size(), 2u);
  EXPECT_EQ(file.groups[0].name, "cloth:sheet");
  EXPECT_EQ(file.groups[0].face_count, 5);
  EXPECT_EQ(file.groups[1].name, "obstacle:ground");
  EXPECT_EQ(file.groups[1].first_face, 5);
  EXPECT_EQ(file.groups[1].face_count, 1);
}

TEST(MeshIo, ObjTextureCoordinatesAreKeptPerCorner) {
  const MeshFile file = read_mesh(kData + "groups.obj");
  ASSERT_EQ(file.mesh.uv.size(), file.mesh.faces.size());
  EXPECT_EQ(file.mesh.uv[3][1].x, 2.5);
  EXPECT_EQ(file.mesh.uv[3][2].y, 1.0);
}

TEST(MeshIo, ObjWithSomeCornersWithoutUvHasNone) {
  const MeshFile file =
      parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\n", "a.obj");
  EXPECT_EQ(file.mesh.faces.size(), 2u);
  EXPECT_TRUE(file.mesh.uv.empty());
  EXPECT_EQ(file.groups.at(0).name, "a");
}

TEST(MeshIo, ObjWithCarriageReturnsAndNoFinalNewline) {
  const MeshFile file = parse_obj("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3", "a.obj");
  EXPECT_EQ(file.mesh.faces, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(MeshIo, ObjLinesGoOnAfterABackslash) {
  for (const std::string end : {"\n", "\r\n"}) {
    std::string text;
    for (const char* line : {"# a path: C:\\", "v 0 \\", " 0\\", "0", "v 1 0 0", "v 0 1 0 # up \\",
                             "g \\", "sheet", "f 1\\", "2 \\", "3", "f 3 2 1 \\"})
      text += line + end;
    const MeshFile file = parse_obj(text, "a.obj");
    EXPECT_EQ(file.mesh.positions.size(), 3u);
    EXPECT_EQ(file.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
    EXPECT_EQ(file.groups.at(0).name, "sheet");
  }
}

TEST(MeshIo, AByteOrderMarkHidesNoVertex) {
  const MeshFile file = parse_obj("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(file.mesh.positions.size(), 3u);
}

TEST(MeshIo, LinesAreCountedAsEditorsDo) {
  const std::string text = "v 0 \\\n0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 \\\n9\nf 1 2 8\n";
  try {
    parse_obj(text, "a.obj");
    FAIL() << "expected a refusal";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("a.obj: line 7: face 2: value '9'"))
        << error.what();
  }
}

TEST(MeshIo, AsciiPlySkipsOtherProperties) {
  const MeshFile file = read_mesh(kData + "square.ply");
  EXPECT_EQ(file.mesh.positions.at(2), (Vec3d{1, 1, 0.25}));
  EXPECT_EQ(file.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A value with its bytes in either order.
template <class T>
void append(std::string& bytes, T value, bool big_endian) {
  std::string one;
  append(one, value);
  if (big_endian) std::ranges::reverse(one);
  bytes += one;
}

TEST(MeshIo, BinaryPlyOfEitherByteOrderWithFacesBeforeVertices) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat ") +
                        (big ? "binary_big_endian" : "binary_little_endian") +
                        " 1.0\nelement face 1\nproperty ushort flag\n"
                        "property list uint ushort vertex_index\nelement vertex 3\n"
                        "property double x\nproperty double y\nproperty float z\nend_header\n";
    append(bytes, std::uint16_t{7}, big);
    append(bytes, std::uint32_t{3}, big);
    for (int v = 2; v >= 0; --v) append(bytes, static_cast<std::uint16_t>(v), big);
    for (int v = 0; v < 3; ++v) {
      append(bytes, 0.1 + v, big);
      append(bytes, 2.0 * v * v, big);
      append(bytes, -0.5f, big);
    }
    const MeshFile file = parse_ply(bytes, "a.ply");
    EXPECT_EQ(file.mesh.faces, (std::vector<Triangle>{{2, 1, 0}}));
    EXPECT_EQ(file.mesh.positions.at(2), (Vec3d{2.1, 8, -0.5}));
  }
}

TEST(MeshIo, WrittenObjReadsBackBitForBit) {
  const TemporaryFolder folder;
  const std::vector<Vec3f> sheet = {{0.1f, 1.0f / 3, -2e-7f}, {1, 16777215, 3}, {0, 0, 1e-30f}};
  const std::vector<Vec3f> ball = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> one = {{0, 1, 2}}, two = {{0, 2, 1}, {1, 2, 3}};
  const std::vector<NamedMesh> objects = {{"cloth:a", sheet, one}, {"obstacle:b", ball, two}};
  const std::string path = folder.path("frame.obj");
  write_obj(path, objects);
  const MeshFile file = read_mesh(path);
  ASSERT_EQ(file.mesh.positions.size(), 7u);
  for (std::size_t v = 0; v < 3; ++v)
    EXPECT_EQ(convert<float>(file.mesh.positions[v]), sheet[v]) << v;
  EXPECT_EQ(file.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {3, 5, 4}, {4, 5, 6}}));
  EXPECT_EQ(file.groups.at(1).name, "obstacle:b");
  // Nothing but the file itself is left in the folder.
  const auto entries = std::filesystem::directory_iterator(folder.path(""));
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

std::string pc2_bytes(std::int32_t vertices, std::int32_t frames) {
  std::string bytes("POINTCACHE2\0", 12);
  append<std::int32_t>(bytes, 1);
  append(bytes, vertices);
  append(bytes, 0.0f);
  append(bytes, 1.0f);
  append(bytes, frames);
  return bytes;
}

TEST(MeshIo, Pc2FramesAreReadInOrder) {
  const TemporaryFolder folder;
  std::string bytes = pc2_bytes(2, 3);
  for (int i = 0; i < 18; ++i) append(bytes, 0.5f * static_cast<float>(i));
  const auto frames = read_point_cache(folder.write("a.pc2", bytes), 2).frames;
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].at(1), (Vec3f{7.5f, 8.0f, 8.5f}));
}

void append_big_endian(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
}

std::string mdd_bytes(std::uint32_t points, const std::vector<float>& times) {
  std::string bytes;
  append_big_endian(bytes, static_cast<std::uint32_t>(times.size()));
  append_big_endian(bytes, points);
  for (float time : times) append_big_endian(bytes, std::bit_cast<std::uint32_t>(time));
  for (std::size_t i = 0; i < 3 * points * times.size(); ++i)
    append_big_endian(bytes, std::bit_cast<std::uint32_t>(0.5f * static_cast<float>(i)));
  return bytes;
}

TEST(MeshIo, MddFramesAreReadInOrder) {
  const TemporaryFolder folder;
  const std::string bytes = mdd_bytes(2, {0, 0.04f, 0.08f});
  EXPECT_EQ(bytes.substr(0, 8), std::string("\0\0\0\3\0\0\0\2", 8));  // big endian
  const PointCache cache = read_point_cache(folder.write("a.MDD", bytes), 2);
  ASSERT_EQ(cache.frames.size(), 3u);
  EXPECT_EQ(cache.frames[0].at(0), (Vec3f{0, 0.5f, 1}));
  EXPECT_EQ(cache.frames[2].at(1), (Vec3f{7.5f, 8.0f, 8.5f}));
  EXPECT_NEAR(cache.frame_rate, 25, 1e-4);
}

TEST(MeshIo, MddTimesGiveTheFrameRateOnlyWhereTheyAreEven) {
  const auto rate = [](const std::vector<float>& times) {
    return parse_mdd(mdd_bytes(1, times), "a.mdd", 1).frame_rate;
  };
  EXPECT_NEAR(rate({1, 1.034f, 1.066f, 1.1f}), 30, 1e-3);  // rounded by the writer
  EXPECT_EQ(rate({0, 0, 0}), 0);
  EXPECT_EQ(rate({0}), 0);
  EXPECT_EQ(rate({0, 0.1f, 0.5f}), 0);
  EXPECT_EQ(rate({0.2f, 0.1f, 0}), 0);
  EXPECT_EQ(rate({0, 1e-30f}), 0);
  EXPECT_EQ(parse_pc2(pc2_bytes(1, 1) + std::string(12, '\0'), "a.pc2", 1).frame_rate, 0);
}

TEST(MeshIo, OutsideBodiesAreRead) {
  const std::string folder = outside_data() + "/bodies/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no reference data in " << outside_data();
  const TriangleMesh rumba = read_body(folder + "rumba.obj").mesh;
  EXPECT_EQ(rumba.positions.size(), 12811u);
  EXPECT_EQ(rumba.faces.size(), 25472u);
  const auto frames = read_point_cache(folder + "rumba.pc2", 12811).frames;
  EXPECT_EQ(frames.size(), 121u);
}

TEST(MeshIo, SkinnedBodiesStandUprightInMetres) {
  const std::string path = outside_data() + "/bodies/cesium_man.gltf";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference data in " << outside_data();
  const TriangleMesh man = read_body(path).mesh;
  double low = 1e9, high = -1e9;
  for (Vec3d p : man.positions) low = std::min(low, p.y), high = std::max(high, p.y);
  EXPECT_NEAR(low, 0, 0.02);
  EXPECT_NEAR(high, 1.5, 0.1);
  EXPECT_EQ(man.faces.size(), 4672u);
}

TEST(MeshIo, BinaryPlyOfTheReferenceData) {
  const std::string path = outside_data() + "/ccd/cloth-funnel/227.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference data in " << outside_data();
  const MeshFile file = read_mesh(path);
  EXPECT_EQ(file.mesh.positions.size(), 9450u);
  EXPECT_EQ(file.mesh.faces.size(), 18484u);
  EXPECT_NO_THROW(check_cloth_mesh(file.mesh, "227.ply"));
}

}  // namespace
}  // namespace icloth
