// States of a run as numbered files.
#include "sim/files/frame_export.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "tests/support/temporary_folder.h"

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
