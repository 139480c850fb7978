// States of a run as numbered files.
#include "sim/files/frame_export.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/usda_reader.h"

namespace icloth {
namespace {

const std::vector<Vec3f> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Triangle> kFace = {{0, 1, 2}};

/// Exports a run of so many steps.
void run(FrameExport& frames, std::int64_t steps) {
  for (std::int64_t step = 0; step <= steps; ++step) {
    std::vector<Vec3f> moved = kCorners;
    moved[0].z = static_cast<float>(step);
    const std::vector<NamedMesh> meshes = {{"cloth:a", moved, kFace}};
    if (frames.wants(step, step == steps))
      frames.write(meshes, step, 0.01 * static_cast<double>(step), step == steps);
  }
}

TEST(FrameExport, TheLastStateIsAlwaysWritten) {
  const TemporaryFolder folder;
  FrameExport frames(folder.path("out"), 10);
  run(frames, 25);
  EXPECT_EQ(read_file(folder.path("out/frames.csv")),
            "frame,step,time\n0,0,0\n1,10,0.1\n2,20,0.2\n3,25,0.25\n");
  const std::string last = read_file(folder.path("out/frame_00003.obj"));
  EXPECT_TRUE(last.starts_with("# step 25, time 0.25 s\ng cloth:a\nv 0 0 25\n")) << last;
  EXPECT_EQ(read_file(folder.path("out/last.obj")), last);
  EXPECT_EQ(read_mesh(folder.path("out/last.obj")).mesh.positions[0].z, 25);
  EXPECT_FALSE(std::filesystem::exists(folder.path("out/frame_00004.obj")));
}

TEST(FrameExport, ALastStateThatIsAFrameIsNotWrittenTwice) {
  const TemporaryFolder folder;
  FrameExport frames(folder.path("out"), 10);
  run(frames, 20);
  EXPECT_EQ(read_file(folder.path("out/frames.csv")),
            "frame,step,time\n0,0,0\n1,10,0.1\n2,20,0.2\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path("out/frame_00003.obj")));
  EXPECT_TRUE(std::filesystem::exists(folder.path("out/last.obj")));
}

/// The positions of a step of run() below.
std::vector<Vec3f> corners_at(std::int64_t step) {
  std::vector<Vec3f> moved = kCorners;
  moved[0] = {0.1f * static_cast<float>(step), 1e-30f, -1.0f / 3};
  return moved;
}

/// Exports steps from `first` on of two objects whose names differ in a character that files lack.
void run_two(FrameExport& frames, std::int64_t first, std::int64_t steps) {
  for (std::int64_t step = first; step <= steps; ++step) {
    const std::vector<Vec3f> moved = corners_at(step), still = kCorners;
    const std::vector<NamedMesh> meshes = {{"cloth:a/b", moved, kFace},
                                           {"cloth:a:b", still, kFace}};
    if (frames.wants(step, step == steps))
      frames.write(meshes, step, 0.01 * static_cast<double>(step), step == steps);
  }
}

constexpr FrameFormat kCaches[] = {FrameFormat::pc2, FrameFormat::mdd};
constexpr FrameFormat kPly[] = {FrameFormat::ply};

TEST(FrameExport, PointCachesAreReadBackBitForBit) {
  const TemporaryFolder folder;
  FrameExport frames(folder.path("out"), 5, kCaches);
  run_two(frames, 0, 23);

  // Step 23 ends the run between two frames and is in no cache, whose frames are even.
  for (const char* format : {"pc2", "mdd"})
    for (const char* name : {"cloth_a_b.", "cloth_a_b_2."}) {
      const PointCache cache = read_point_cache(folder.path("out/") + name + format, 3);
      ASSERT_EQ(cache.frames.size(), 5u);
      EXPECT_TRUE(cache.unused.empty());
      for (std::int64_t f = 0; f < 5; ++f)
        EXPECT_EQ(cache.frames[static_cast<std::size_t>(f)],
                  std::string(name) == "cloth_a_b." ? corners_at(5 * f) : kCorners);
    }
  EXPECT_NEAR(read_point_cache(folder.path("out/cloth_a_b.mdd"), 3).frame_rate, 20, 1e-4);
  EXPECT_EQ(read_mesh(folder.path("out/cloth_a_b.obj")).mesh.faces, kFace);
}

TEST(FrameExport, UsdaIsReadBackBitForBit) {
  const TemporaryFolder folder;
  constexpr FrameFormat kUsda[] = {FrameFormat::usda};
  FrameExport frames(folder.path("out"), 5, kUsda);
  const std::vector<std::array<Vec2d, 3>> uv = {{{{0, 0}, {0.5, 0}, {0, 0.25}}}};
  for (std::int64_t step = 0; step <= 12; ++step) {
    const std::vector<Vec3f> moved = corners_at(step);
    const std::vector<NamedMesh> meshes = {{"cloth:a-1", moved, kFace, uv},
                                           {"cloth:a 1", kCorners, kFace}};
    if (frames.wants(step, step == 12))
      frames.write(meshes, step, 0.02 * static_cast<double>(step), step == 12);
  }
  const std::string text = read_file(folder.path("out/scene.usda"));
  testing::UsdaStage stage = testing::UsdaReader(text).read();
  EXPECT_EQ(stage.metadata["upAxis"], "\"Y\"");
  EXPECT_EQ(stage.metadata["metersPerUnit"], "1");
  EXPECT_EQ(stage.metadata["endTimeCode"], "2");
  EXPECT_EQ(stage.metadata["timeCodesPerSecond"], "10");

  // Names that differ only in what the format does not take stay two.
  ASSERT_EQ(stage.meshes.size(), 2u);
  testing::UsdaMesh& mesh = stage.meshes.at("\"cloth_a_1\"");
  EXPECT_TRUE(stage.meshes.contains("\"cloth_a_1_2\""));
  EXPECT_EQ(mesh.values["faceVertexCounts"], (std::vector<double>{3}));
  EXPECT_EQ(mesh.values["faceVertexIndices"], (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(mesh.values["primvars:st"], (std::vector<double>{0, 0, 0.5, 0, 0, 0.25}));
  ASSERT_EQ(mesh.samples["points"].size(), 3u);
  for (std::int64_t f = 0; f < 3; ++f) {
    const std::vector<Vec3f> moved = corners_at(5 * f);
    const std::vector<double>& points = mesh.samples["points"].at(static_cast<double>(f));
    ASSERT_EQ(points.size(), 9u);
    for (std::size_t v = 0; v < 3; ++v)
      EXPECT_EQ((Vec3f{static_cast<float>(points[3 * v]), static_cast<float>(points[3 * v + 1]),
                       static_cast<float>(points[3 * v + 2])}),
                moved[v]);

    // All normals are that of the one face, and the extent holds its corners.
    const Vec3f n = normalized(cross(moved[1] - moved[0], moved[2] - moved[0]));
    const std::vector<double>& normals = mesh.samples["normals"].at(static_cast<double>(f));
    EXPECT_EQ(static_cast<float>(normals[2]), n.z);
    EXPECT_EQ(mesh.samples["extent"].at(static_cast<double>(f)).size(), 6u);
    EXPECT_EQ(static_cast<float>(mesh.samples["extent"].at(static_cast<double>(f))[2]), moved[0].z);
  }
}

TEST(FrameExport, PlyIsReadBackBitForBit) {
  const TemporaryFolder folder;
  FrameExport frames(folder.path("out"), 10, kPly);
  run_two(frames, 0, 10);
  const TriangleMesh mesh = read_mesh(folder.path("out/frame_00001.ply")).mesh;
  ASSERT_EQ(mesh.positions.size(), 6u);
  const std::vector<Vec3f> moved = corners_at(10);
  for (std::size_t v = 0; v < 3; ++v) {
    EXPECT_EQ(convert<float>(mesh.positions[v]), moved[v]);
    EXPECT_EQ(convert<float>(mesh.positions[3 + v]), kCorners[v]);
  }
  EXPECT_EQ(mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(FrameExport, CachesThatAreContinuedEqualThoseOfOneRun) {
  const TemporaryFolder folder;
  FrameExport whole(folder.path("whole"), 5, kCaches);
  run_two(whole, 0, 40);

  // The first run goes to step 23, and its state after step 20 is gone on from.
  {
    FrameExport first(folder.path("cut"), 5, kCaches);
    run_two(first, 0, 23);
  }
  FrameExport second(folder.path("cut"), 5, kCaches, 17);
  run_two(second, 17, 40);
  for (const char* name : {"cloth_a_b.pc2", "cloth_a_b.mdd", "cloth_a_b_2.pc2", "frames.csv"})
    EXPECT_EQ(read_file(folder.path("cut/") + name), read_file(folder.path("whole/") + name))
        << name;

  // A cache of another mesh is refused.
  write_file(folder.path("cut/cloth_a_b.pc2"), std::string(500, 'x'));
  FrameExport third(folder.path("cut"), 5, kCaches, 17);
  EXPECT_THROW(run_two(third, 20, 40), InputError);
}

TEST(FrameExport, WithoutAFolderNothingIsWanted) {
  EXPECT_FALSE(FrameExport("", 1).wants(0, true));
}

/// No file of this process can grow beyond so many bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(FrameExport, AFullDiskLeavesWholeFramesInACache) {
  // Each frame of both objects takes 36 bytes, and no file can have more than 200.
  const TemporaryFolder folder;
  FrameExport frames(folder.path("out"), 1, kCaches);
  std::filesystem::create_directories(folder.path("out"));
  {
    const FullDisk full(200);
    EXPECT_THROW(run_two(frames, 0, 100), InputError);
  }
  for (const char* name : {"cloth_a_b.pc2", "cloth_a_b_2.pc2"}) {
    const PointCache cache = read_point_cache(folder.path("out/") + name, 3);
    ASSERT_EQ(cache.frames.size(), 4u);
  }
  const std::string list = read_file(folder.path("out/frames.csv"));
  EXPECT_EQ(std::ranges::count(list, '\n'), 5) << list;
}

TEST(OutputFile, IsWholeOrNotThere) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.txt");
  write_file(path, "before");
  {
    const FullDisk full(1000);
    EXPECT_THROW(write_file(path, std::string(100'000, 'x')), InputError);
    EXPECT_THROW(write_file(folder.path("b.txt"), std::string(100'000, 'x')), InputError);
  }
  EXPECT_EQ(read_file(path), "before");
  EXPECT_EQ(files_in(folder.path("")), 1u);
  {
    OutputFile file(folder.path("c.txt"));
    file.write("never committed");
  }
  EXPECT_EQ(files_in(folder.path("")), 1u);
}

TEST(OutputFile, WhatIsAddedIsWholeOrTakenBack) {
  const TemporaryFolder folder;
  const std::string path = folder.path("rows.csv");
  write_file(path, "a,b\n");
  append_file(path, "1,2\n");
  {
    const FullDisk full(1000);
    EXPECT_THROW(append_file(path, std::string(100'000, 'x')), InputError);
  }
  EXPECT_EQ(read_file(path), "a,b\n1,2\n");
}

TEST(OutputFile, DevicesAreWrittenToAndStay) {
  try {
    write_file("/dev/full", "text");
    FAIL() << "expected a refusal";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("/dev/full: cannot be written (No space"))
        << error.what();
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_NO_THROW(write_file("/dev/null", "text"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(OutputFile, FollowsLinks) {
  const TemporaryFolder folder;
  write_file(folder.path("target.txt"), "old");
  std::filesystem::create_symlink("target.txt", folder.path("link.txt"));
  std::filesystem::create_symlink("/dev/full", folder.path("full.txt"));
  write_file(folder.path("link.txt"), "new");
  EXPECT_EQ(read_file(folder.path("target.txt")), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.txt")));
  EXPECT_THROW(write_file(folder.path("full.txt"), "new"), InputError);
}

}  // namespace
}  // namespace icloth
