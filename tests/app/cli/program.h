// The built program in a folder of its own, run as a user runs it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace icloth::testing {

namespace fs = std::filesystem;

/// A small sheet 1 mm above a ball; the ball is wide enough to catch it.
inline constexpr const char* kDrop = R"({
  "name": "Drop", "time_step": 0.01, "duration": 0.2,
  "cloths": [ { "name": "sheet", "mesh": { "grid": { "size": [0.2, 0.2] } }, "triangles": 200,
                "transform": { "translate": [0, 0.11, 0], "rotate": [90, 0, 0] } } ],
  "obstacles": [ { "name": "ball", "mesh": { "sphere": { "radius": 0.1, "triangles": 300 } } } ]
})";

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Every test has an empty folder of its own, where the program runs.
class Cli : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    base_ = fs::path(::testing::TempDir()) / ("icloth_cli_" + std::string(info->name()));
    fs::remove_all(base_);
    fs::create_directories(folder_ = base_ / "here");
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(base_);
  }

  /// `arguments` as typed into a shell, where `> FILE` leads the output elsewhere; `environment` as
  /// VAR=VALUE words before the program.
  Outcome icloth(const std::string& arguments, const std::string& environment = "") const {
    const fs::path out = base_ / "out", err = base_ / "err";
    const std::string command = "cd '" + folder_.string() + "' && { env " + environment +
                                " timeout " ICLOTH_PROGRAM_SECONDS " '" ICLOTH_PROGRAM "' " +
                                arguments + " ; } > '" + out.string() + "' 2> '" + err.string() +
                                "' < /dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  /// Exit code 2, one line on stderr, nothing on stdout, no file made.
  void expect_bad_input(const std::string& arguments, const std::string& part) const {
    const std::size_t before = files();
    const Outcome outcome = icloth(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("icloth: ")) << arguments << "\n" << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1u) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(contains(outcome.err, part)) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(files(), before) << arguments;
  }

  fs::path folder_;

 private:
  fs::path base_;
};

}  // namespace icloth::testing
