// A scene whose body is a file that somebody made to break the program. Each of these files ends
// the program in order: exit code 2, one line, little time and little memory.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/app/cli/hostile_formats.h"
#include "tests/app/cli/hostile_gltf.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

constexpr long kMostMemory = 1 << 20;  // [KiB] of the program or of the process that reads for it
constexpr double kMostSeconds = 10;    // of processor time

struct Outcome {
  int code = -1;  ///< of the program; -1: it was killed
  double seconds = 0;
  long memory = 0;  ///< [KiB]
  std::string out, err;
};

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Runs the program, which `timeout` ends where it waits for something that does not come.
Outcome run(const TemporaryFolder& folder, const std::string& scene, int steps = 0) {
  const std::string out = folder.path("stdout"), err = folder.path("stderr");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  for (const auto& [number, path] : {std::pair{1, out}, {2, err}})
    posix_spawn_file_actions_addopen(&actions, number, path.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
  std::string words[] = {"timeout",  "60",      ICLOTH_PROGRAM,        "run",
                         scene,      "--steps", std::to_string(steps), "--quiet",
                         "--device", "cpu"};

  // posix_spawn takes its words as char*.
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int failure = posix_spawnp(&child, "timeout", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  EXPECT_EQ(failure, 0);

  // The use of a process includes that of the processes it has waited for, the reader among them.
  int status = 0;
  rusage use{};
  wait4(child, &status, 0, &use);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          seconds(use.ru_utime) + seconds(use.ru_stime), use.ru_maxrss, contents(out),
          contents(err)};
}

/// A scene with a small cloth, far from a body.
std::string scene_with(const TemporaryFolder& folder, const std::string& body,
                       const Json& keys = Json::object()) {
  Json scene = {{"cloths",
                 {{{"mesh", {{"grid", {{"size", {1, 1}}}}}},
                   {"triangles", 2},
                   {"transform", {{"translate", {0, 40, 0}}}}}}},
                {"obstacles", {{{"name", "body"}, {"mesh", body}}}}};
  scene["obstacles"][0].update(keys);
  return folder.write("scene.json", scene.dump());
}

void expect_refused(const TemporaryFolder& folder, const std::string& body,
                    const Json& keys = Json::object()) {
  const Outcome outcome = run(folder, scene_with(folder, body, keys));
  const std::string what = body + " " + keys.dump() + " (" + std::to_string(outcome.seconds) +
                           " s, " + std::to_string(outcome.memory >> 10) + " MB): " + outcome.err;
  EXPECT_EQ(outcome.code, 2) << what;
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << what;
  EXPECT_TRUE(outcome.err.starts_with("icloth: ")) << what;
  EXPECT_LT(outcome.err.size(), 1000u) << what;
  EXPECT_EQ(outcome.out, "") << what;
  EXPECT_LT(outcome.seconds, kMostSeconds) << what;
  EXPECT_LT(outcome.memory, kMostMemory) << what;
}

/// All files of a kind are refused.
void expect_all_refused(void (*add)(std::vector<HostileFile>&), std::size_t least) {
  const TemporaryFolder folder;
  std::vector<HostileFile> files;
  add(files);
  EXPECT_GE(files.size(), least);
  for (const HostileFile& file : files) {
    folder.write(file.name, file.bytes);
    expect_refused(folder, file.name);
    fs::remove(folder.path(file.name));
  }
}

TEST(HostileBodies, TheFileThatTheOthersChangeIsGood) {
  const TemporaryFolder folder;
  folder.write("good.glb", changed_glb({}));
  folder.write("good.dae", collada(collada_mesh(kNineFloats, "9", "0 1 2")));
  for (const char* name : {"good.glb", "good.dae"}) {
    const Outcome outcome = run(folder, scene_with(folder, name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
}

TEST(HostileBodies, BrokenNumbersOfGltfAreRefused) { expect_all_refused(add_broken_numbers, 14); }
TEST(HostileBodies, BrokenReferencesOfGltfAreRefused) {
  expect_all_refused(add_broken_references, 30);
}
TEST(HostileBodies, BrokenShapesOfGltfAreRefused) { expect_all_refused(add_broken_shapes, 10); }
TEST(HostileBodies, BrokenXmlIsRefused) { expect_all_refused(add_xml, 15); }
TEST(HostileBodies, BrokenFbxIsRefused) { expect_all_refused(add_fbx, 12); }
TEST(HostileBodies, BrokenTextsAreRefused) { expect_all_refused(add_texts, 25); }
TEST(HostileBodies, BrokenBinariesAreRefused) { expect_all_refused(add_binaries, 40); }
TEST(HostileBodies, BrokenArchivesAreRefused) { expect_all_refused(add_archives, 5); }
TEST(HostileBodies, MisnamedEmptyAndCutFilesAreRefused) { expect_all_refused(add_misnamed, 25); }

TEST(HostileBodies, BrokenMotionsAreRefused) {
  const TemporaryFolder folder;
  folder.write("good.glb", changed_glb({}));
  std::vector<HostileFile> files;
  add_motions(files);
  EXPECT_GE(files.size(), 15u);
  for (const HostileFile& file : files) {
    folder.write(file.name, file.bytes);
    expect_refused(folder, "good.glb", {{"animation", file.name}});
  }
  ASSERT_EQ(mkfifo(folder.path("pipe.bvh").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder.path("zero.bvh"));
  for (const char* name : {"pipe.bvh", "zero.bvh", "none.bvh", "../good.bvh", "/dev/stdin.bvh"})
    expect_refused(folder, "good.glb", {{"animation", name}});
}

/// The clip is played to its end and beyond, where all that a file can do has been done.
TEST(HostileBodies, WhatIsReadWithoutItsBrokenPartsIsSimulated) {
  const TemporaryFolder folder;
  std::vector<HostileFile> files;
  add_harmless(files);
  EXPECT_GE(files.size(), 9u);
  for (const HostileFile& file : files) {
    folder.write(file.name, file.bytes);
    const Outcome outcome = run(folder, scene_with(folder, file.name, {{"clip", 0}}), 120);
    EXPECT_EQ(outcome.code, 0) << file.name << ": " << outcome.err;
    EXPECT_EQ(outcome.err, "") << file.name;
    EXPECT_LT(outcome.memory, kMostMemory) << file.name;
  }
}

TEST(HostileBodies, WhatIsNoFileIsRefusedAtOnce) {
  const TemporaryFolder folder;
  for (const char* name : {"pipe.glb", "pipe.obj", "pipe.bin"})
    ASSERT_EQ(mkfifo(folder.path(name).c_str(), 0600), 0);
  fs::create_directory(folder.path("folder.fbx"));
  fs::create_symlink("/dev/zero", folder.path("zero.stl"));
  fs::create_symlink("round.dae", folder.path("round.dae"));
  fs::create_symlink("nothing", folder.path("dangling.dae"));
  std::ofstream(folder.path("hollow.fbx")).close();
  fs::resize_file(folder.path("hollow.fbx"),
                  std::uintmax_t{3} << 30);  // takes no place on the disk
  for (const char* name : {"pipe.glb", "pipe.obj", "hollow.fbx", "folder.fbx", "zero.stl",
                           "round.dae", "dangling.dae", "none.glb", "", ".", "/dev/stdin"})
    expect_refused(folder, name);
}

TEST(HostileBodies, BuffersElsewhereAreNotOpened) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path("below"));
  std::string data;
  Json text = make_gltf({}, data);
  folder.write("outside.bin", data);
  folder.write("below/inside.bin", data);

  // The same buffer is inside and outside, and there are several ways to what is not a file.
  ASSERT_EQ(mkfifo(folder.path("below/pipe.bin").c_str(), 0600), 0);
  fs::create_symlink(folder.path("outside.bin"), folder.path("below/link.bin"));
  fs::create_directory_symlink(folder.path(""), folder.path("below/shelf"));
  fs::create_symlink("/dev/zero", folder.path("below/zero.bin"));
  const auto write_body = [&](const std::string& uri) {
    text["buffers"][0]["uri"] = uri;
    folder.write("below/a.gltf", text.dump());
  };

  // The good one comes last, as the control.
  for (const std::string& uri :
       {std::string("../outside.bin"), folder.path("outside.bin"), std::string("link.bin"),
        std::string("shelf/outside.bin"), std::string("pipe.bin"), std::string("zero.bin"),
        std::string("none.bin"), std::string("."), std::string("file:///etc/passwd"),
        std::string("%2e%2e/outside.bin")}) {
    write_body(uri);
    expect_refused(folder, "below/a.gltf");
  }
  write_body("inside.bin");
  EXPECT_EQ(run(folder, scene_with(folder, "below/a.gltf")).code, 0);
}

}  // namespace
}  // namespace icloth
