// Formats that are made from the point caches of a run, which a crash may have cut off.
#include "sim/files/spool.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <random>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/spool_export.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

const std::vector<Triangle> kFaces = {{0, 1, 2}, {2, 1, 3}};
const std::vector<std::array<Vec2d, 3>> kUv = {{{{0, 0}, {0.1, 0}, {0, 1.0 / 3}}},
                                               {{{0, 1.0 / 3}, {0.1, 0}, {0.1, -0.0}}}};
constexpr FrameFormat kAll[] = {FrameFormat::obj, FrameFormat::ply, FrameFormat::pc2,
                                FrameFormat::mdd, FrameFormat::usda};

std::vector<Vec3f> places(std::int64_t step, float shift) {
  const float t = static_cast<float>(step) / 3;
  return {{t, 1e-30f, shift}, {1, t, -t}, {0, 1, t / 7}, {1, 1, 0.1f * t}};
}

/// Exports every 5th step of a run of so many steps, which ends in order or is cut off.
void run(const std::string& folder, std::int64_t steps, bool in_order) {
  FrameExport frames(folder, 5, kAll);
  for (std::int64_t step = 0; step <= steps; ++step) {
    const std::vector<Vec3f> a = places(step, 0.25f), b = places(2 * step, -1), c = places(0, 0);
    // Names may hold anything: commas, line breaks, and characters that no file has.
    const std::vector<NamedMesh> meshes = {
        {"cloth:b,c\nd", a, kFaces, kUv}, {"cloth:b c d", b, kFaces}, {"obstacle:a", c, kFaces}};
    const bool last = in_order && step == steps;
    if (frames.wants(step, last))
      frames.write(meshes, step, 0.007 * static_cast<double>(step), last);
  }
}

std::vector<std::string> files_of(const std::string& folder, const std::string& extension) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension) names.push_back(entry.path().filename().string());
  return names;
}

/// Every file of that extension in `a` is in `b`, with the same bytes.
void expect_same_files(const std::string& a, const std::string& b, const std::string& extension,
                       std::size_t count) {
  const std::vector<std::string> names = files_of(a, extension);
  EXPECT_EQ(names.size(), count) << extension;
  for (const std::string& name : names)
    EXPECT_EQ(read_file(a + "/" + name), read_file(b + "/" + name)) << name;
}

TEST(Spool, ARunThatWasCutOffGivesTheFilesOfOneThatEnded) {
  // The run was cut off after step 23, and its last whole frame is that of step 20.
  const TemporaryFolder folder;
  run(folder.path("whole"), 20, true);
  run(folder.path("cut"), 23, false);
  EXPECT_FALSE(fs::exists(folder.path("cut/scene.usda")));

  const Spool spool = read_spool(folder.path("cut"));
  EXPECT_TRUE(spool.notes.empty());
  EXPECT_EQ(spool.frames.size(), 5u);
  fs::create_directory(folder.path("made"));
  for (const FrameFormat format : kAll) export_spool(spool, folder.path("made"), format);
  expect_same_files(folder.path("made"), folder.path("whole"), ".mdd", 3);
  expect_same_files(folder.path("made"), folder.path("whole"), ".pc2", 3);
  expect_same_files(folder.path("made"), folder.path("whole"), ".ply", 5);
  expect_same_files(folder.path("made"), folder.path("whole"), ".usda", 1);
  expect_same_files(folder.path("made"), folder.path("whole"), ".csv", 2);

  // Five frames, and the faces of three caches.
  expect_same_files(folder.path("made"), folder.path("whole"), ".obj", 8);
}

TEST(Spool, AStateBetweenTwoFramesIsInNoCache) {
  const TemporaryFolder folder;
  run(folder.path("whole"), 23, true);
  const Spool spool = read_spool(folder.path("whole"));
  EXPECT_TRUE(spool.notes.empty());
  EXPECT_EQ(spool.frames.size(), 5u);

  // The same where it is the second one.
  run(folder.path("short"), 3, true);
  EXPECT_EQ(read_spool(folder.path("short")).frames.size(), 1u);
  EXPECT_TRUE(read_spool(folder.path("short")).notes.empty());
}

TEST(Spool, WhatACrashLeftOfAFrameIsCutOffAndSaid) {
  const TemporaryFolder folder;
  run(folder.path("cut"), 23, false);
  const std::string list = folder.path("cut/frames.csv"), rows = read_file(list);
  const std::string cache = folder.path("cut/cloth_b_c_d.pc2"), bytes = read_file(cache);

  // The bytes of a frame were being appended.
  append_file(cache, "half a frame");
  Spool spool = read_spool(folder.path("cut"));
  EXPECT_EQ(spool.frames.size(), 5u);
  ASSERT_EQ(spool.notes.size(), 1u);
  EXPECT_NE(spool.notes[0].find("its last 12 bytes"), std::string::npos) << spool.notes[0];
  write_file(cache, bytes);

  // A frame is in the caches, and its row was being written.
  write_file(list, rows.substr(0, rows.size() - 3));
  spool = read_spool(folder.path("cut"));
  EXPECT_EQ(spool.frames.size(), 4u);
  ASSERT_EQ(spool.notes.size(), 1u);
  EXPECT_NE(spool.notes[0].find("frame 4 was not finished"), std::string::npos) << spool.notes[0];
  write_file(list, rows);

  // A cache has lost its end.
  write_file(cache, bytes.substr(0, bytes.size() - 60));
  spool = read_spool(folder.path("cut"));
  EXPECT_EQ(spool.frames.size(), 3u);
  EXPECT_NE(spool.notes.back().find("3 of the 5 frames"), std::string::npos) << spool.notes.back();
}

/// The message with which a spool is refused after `change` of one of its files.
std::string refusal(const std::string& file, const std::function<void(std::string&)>& change) {
  const TemporaryFolder folder;
  run(folder.path("cut"), 23, false);
  std::string bytes = read_file(folder.path("cut/" + file));
  change(bytes);
  write_file(folder.path("cut/" + file), bytes);
  try {
    read_spool(folder.path("cut"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void expect_refused(const std::string& file, const std::string& part,
                    const std::function<void(std::string&)>& change) {
  const std::string message = refusal(file, change);
  EXPECT_NE(message.find(part), std::string::npos) << file << ": " << message;
  EXPECT_NE(message.find(file), std::string::npos) << message;
}

TEST(Spool, WhatIsDamagedIsRefusedWithItsFileAndValue) {
  const std::string cache = "cloth_b_c_d.pc2";
  expect_refused(cache, "header of 32", [](std::string& s) { s.resize(20); });
  expect_refused(cache, "signature", [](std::string& s) { s[0] = 'X'; });
  expect_refused(cache, "version: value 2", [](std::string& s) { s[12] = 2; });
  expect_refused(cache, "vertices: value 5", [](std::string& s) { s[16] = 5; });
  expect_refused(cache, "vertices: value -", [](std::string& s) { s[19] = '\xff'; });
  expect_refused(cache, "frames: value -", [](std::string& s) { s[31] = '\xff'; });
  expect_refused(cache, "frame 1: vertex 0: value nan",
                 [](std::string& s) { s.replace(32 + 48, 4, "\xff\xff\xff\x7f"); });
  expect_refused("cloth_b_c_d.obj", "value 5 vertices, expected 4",
                 [](std::string& s) { s += "v 0 0 0\n"; });
  expect_refused("cloth_b_c_d.obj", "line", [](std::string& s) { s += "f 1 2 9\n"; });

  // Lists of other programs, and rows that no export writes.
  const auto replace = [](const char* from, const char* to) {
    return [=](std::string& s) { s.replace(s.find(from), std::string(from).size(), to); };
  };
  expect_refused("frames.csv", "row 0", replace("frame,", "time,"));
  expect_refused("frames.csv", "row 2: value '7,10,0.07'", replace("2,10", "7,10"));
  expect_refused("frames.csv", "row 2: value '2,5,0.07'", replace("2,10", "2,5"));
  expect_refused("frames.csv", "row 1: value '1,5,nan'", replace("0.035", "nan"));
  expect_refused("frames.csv", "row 1: value '1,5,0.035 x'", replace("0.035", "0.035 x"));
  expect_refused("objects.csv", "row 0", replace("vertices,", "cat,"));
  expect_refused("objects.csv", "row 0: value '0,", replace("4,", "0,"));
  expect_refused("objects.csv", "row 0: value '99999999999,", replace("4,", "99999999999,"));
  expect_refused("objects.csv", "row 0: value '-4,", replace("4,", "-4,"));
  expect_refused("objects.csv", "row 0: value '4,../", replace("4,cloth", "4,../cloth"));
  expect_refused("objects.csv", "row 1", replace("cloth_b_c_d_2.pc2", "cloth_b_c_d.pc2"));
  expect_refused("objects.csv", "0 objects", [](std::string& s) { s.resize(s.find('\n') + 1); });

  // A count that the others do not have takes no memory.
  EXPECT_NE(refusal("objects.csv", replace("4,", "400000000,")).find("expected 400000000"),
            std::string::npos);
}

TEST(Spool, AnyBytesAreReadOrRefused) {
  const TemporaryFolder folder;
  run(folder.path("cut"), 23, false);
  std::mt19937 random(4);
  const auto below = [&](std::size_t n) { return random() % n; };

  // Bytes of a file are changed, taken away or doubled; what is still accepted can be exported.
  std::size_t accepted = 0;
  const std::vector<std::string> names = {"frames.csv", "objects.csv", "cloth_b_c_d.pc2",
                                          "cloth_b_c_d.obj", "obstacle_a.pc2"};
  for (int i = 0; i < 1000; ++i) {
    const std::string path = folder.path("cut/" + names[below(names.size())]);
    const std::string bytes = read_file(path);
    std::string changed = bytes;
    for (std::size_t k = below(3) + 1; k > 0 && !changed.empty(); --k) {
      const std::size_t place = below(changed.size());
      if (below(3) == 0)
        changed.erase(place, below(9));
      else if (below(2) == 0)
        changed.insert(place, changed.substr(place, below(40)));
      else
        changed[place] = static_cast<char>(below(2) == 0 ? random() : "0,-9\n."[below(6)]);
    }
    write_file(path, changed);
    try {
      const Spool spool = read_spool(folder.path("cut"));
      fs::create_directories(folder.path("made"));
      for (const FrameFormat format : kAll) export_spool(spool, folder.path("made"), format);
      ++accepted;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
    write_file(path, bytes);
  }
  EXPECT_GT(accepted, 100u);
  EXPECT_LT(accepted, 900u);
}

TEST(Spool, OtherFoldersAreNone) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path("empty"));
  EXPECT_THROW(read_spool(folder.path("empty")), InputError);
  EXPECT_THROW(read_spool(folder.path("none")), InputError);
  EXPECT_THROW(read_spool(folder.write("file", "text")), InputError);

  // A run that was cut off before its first frame has nothing to give.
  run(folder.path("cut"), 4, false);
  begin_frame_list(folder.path("cut"));
  EXPECT_THROW(read_spool(folder.path("cut")), InputError);
}

TEST(Spool, FramesOfAnEarlierRunAreNotListedByTheNext) {
  const TemporaryFolder folder;
  run(folder.path("out"), 40, true);
  run(folder.path("out"), 7, false);
  EXPECT_EQ(read_spool(folder.path("out")).frames.size(), 2u);
}

TEST(Spool, ARunThatIsResumedAtItsEndWritesAllFormats) {
  const TemporaryFolder folder;
  run(folder.path("whole"), 20, true);
  run(folder.path("cut"), 20, false);
  FrameExport frames(folder.path("cut"), 5, kAll, 20);
  const std::vector<Vec3f> a = places(20, 0.25f), b = places(40, -1), c = places(0, 0);
  const std::vector<NamedMesh> meshes = {
      {"cloth:b,c\nd", a, kFaces, kUv}, {"cloth:b c d", b, kFaces}, {"obstacle:a", c, kFaces}};
  frames.write(meshes, 20, 0.14, true);
  expect_same_files(folder.path("whole"), folder.path("cut"), ".mdd", 3);
  expect_same_files(folder.path("whole"), folder.path("cut"), ".usda", 1);
}

}  // namespace
}  // namespace icloth
