// A run that is interrupted and goes on later has the files of one that was not.
#include <gtest/gtest.h>

#include <csignal>
#include <sstream>

#include "tests/app/cli/program.h"

namespace icloth::testing {
namespace {

namespace fs = std::filesystem;

/// A sheet that hangs by a corner, and a hand that pulls at another from 0.1 s to 0.7 s.
constexpr const char* kPulled = R"({
  "name": "pulled", "time_step": 0.01, "duration": 1,
  "cloths": [ { "name": "sheet", "mesh": { "grid": { "size": [0.3, 0.3] } }, "triangles": 600,
                "pins": ["top_left"], "transform": { "rotate": [60, 10, 0] } } ],
  "input": [ { "vertex": "bottom_right", "release": 0.7,
               "path": [[0.1, 0.1, 0, 0], [0.5, 0.1, 0.1, 0.1], [0.8, 0, 0, 0]] } ]
})";

/// Two layers 20 micrometres apart at the start, closer than the thickness, on a plate.
constexpr const char* kLayers = R"({
  "name": "layers", "time_step": 0.005, "duration": 1,
  "cloths": [
    { "name": "low", "mesh": { "grid": { "size": [0.2, 0.2], "orientation": "horizontal" } },
      "triangles": 400, "transform": { "translate": [0, 0.004, 0] } },
    { "name": "high", "mesh": { "grid": { "size": [0.2, 0.2], "orientation": "horizontal" } },
      "triangles": 450, "transform": { "translate": [0, 0.00402, 0], "rotate": [0, 20, 0] } } ],
  "obstacles": [ { "name": "plate", "mesh": { "box": { "size": [0.5, 0.02, 0.5], "edge": 0.1 } },
                   "transform": { "translate": [0, -0.01, 0] } } ]
})";

/// The column of the state's hash.
std::vector<std::string> hashes(const fs::path& csv) {
  std::ifstream file(csv);
  std::vector<std::string> found;
  std::size_t column = 0;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (found.empty())
      column = static_cast<std::size_t>(std::ranges::find(cells, "state_hash") - cells.begin());
    found.push_back(cells.at(column));
  }
  return found;
}

void expect_equal_folders(const fs::path& a, const fs::path& b) {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(a)) {
    EXPECT_EQ(read(entry.path()), read(b / entry.path().filename())) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 2u);
  EXPECT_EQ(static_cast<std::size_t>(std::distance(fs::directory_iterator(b), {})), files);
}

TEST_F(Cli, ARunThatIsResumedEqualsOneThatWasNotInterrupted) {
  write("pulled.json", kPulled);
  write("layers.json", kLayers);
  for (const std::string scene : {"pulled", "layers"}) {
    const std::string run = "run " + scene + ".json --quiet --device cpu --every 7 ";
    const Outcome whole =
        icloth(run + "--steps 90 --stats whole.csv --out whole --record whole.rec");
    EXPECT_EQ(whole.code, 0) << whole.err;

    // The second one is cut after 40 steps, in the middle of the pull and between two frames.
    const Outcome first =
        icloth(run + "--steps 40 --stats cut.csv --out cut --checkpoint cut.state");
    EXPECT_EQ(first.code, 0) << first.err;
    const Outcome second =
        icloth(run + "--steps 90 --stats cut.csv --out cut --resume cut.state --record cut.rec");
    EXPECT_EQ(second.code, 0) << second.err;
    ASSERT_EQ(hashes(folder_ / "whole.csv").size(), 91u);
    EXPECT_EQ(hashes(folder_ / "cut.csv"), hashes(folder_ / "whole.csv")) << scene;
    EXPECT_EQ(read(folder_ / "cut.rec"), read(folder_ / "whole.rec")) << scene;
    expect_equal_folders(folder_ / "whole", folder_ / "cut");
    fs::remove_all(folder_ / "whole");
    fs::remove_all(folder_ / "cut");
  }
}

TEST_F(Cli, ARunGoesOnFromTheCheckpointThatAKilledOneLeft) {
  write("pulled.json", kPulled);
  const std::string run = "run pulled.json --quiet --device cpu --every 3 ";
  ASSERT_EQ(icloth(run + "--steps 100 --stats whole.csv --out whole").code, 0);

  // Killed at some moment, again and again, the run comes to its end at last.
  const std::string cut = std::string("'") + ICLOTH_PROGRAM + "' " + run +
                          "--steps 100 --stats cut.csv --out cut --checkpoint state "
                          "--checkpoint-every 5 ";
  int attempts = 0, code = 1;
  for (; attempts < 60 && code != 0; ++attempts) {
    const std::string resume = fs::exists(folder_ / "state") ? "--resume state " : "";
    const std::string limit = "timeout -s KILL " + std::to_string(0.2 + 0.1 * attempts) + " ";
    code = std::system(
        ("cd '" + folder_.string() + "' && " + limit + cut + resume + "> /dev/null 2> err")
            .c_str());
  }
  ASSERT_EQ(code, 0) << read(folder_ / "err");
  EXPECT_EQ(hashes(folder_ / "cut.csv"), hashes(folder_ / "whole.csv")) << attempts;

  // What a killed run was just writing stays beside the whole files.
  for (const auto& entry : fs::directory_iterator(folder_ / "cut"))
    if (contains(entry.path().filename().string(), ".tmp")) fs::remove(entry.path());
  expect_equal_folders(folder_ / "whole", folder_ / "cut");
}

TEST_F(Cli, ASignalEndsARunInOrder) {
  write("pulled.json", kPulled);
  const std::string run =
      "run pulled.json --device cpu --steps 100000 --stats cut.csv --out cut "
      "--every 1000000 --record cut.rec --checkpoint cut.state ";

  // Programs that were started in the background ignore some of them, and their children would.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  for (const std::string name : {"INT", "TERM", "HUP"}) {
    // A slow build may still be loading when the signal comes, and is then given more time.
    std::string err;
    for (int delay = 1; delay <= 32 && !contains(err, "ended by"); delay *= 2) {
      const std::string command = "cd '" + folder_.string() + "' && timeout -k 60 -s " + name +
                                  " " + std::to_string(delay) + " '" + ICLOTH_PROGRAM + "' " + run +
                                  "> out 2> err";
      EXPECT_NE(std::system(command.c_str()), 0);
      err = read(folder_ / "err");
    }

    // Everything is there: the summary, the row of the last step, its state and the recording.
    EXPECT_TRUE(contains(err, "ended by SIG" + name + " after ")) << err;
    EXPECT_TRUE(contains(read(folder_ / "out"), "final state")) << name;
    const std::size_t steps = hashes(folder_ / "cut.csv").size() - 1;
    EXPECT_TRUE(contains(err, "after " + std::to_string(steps) + " steps")) << err;
    EXPECT_TRUE(
        read(folder_ / "cut" / "last.obj").starts_with("# step " + std::to_string(steps) + ", "));
    EXPECT_EQ(icloth("replay cut.rec --quiet").code, 0);
    EXPECT_EQ(icloth("run pulled.json --device cpu --quiet --resume cut.state --steps " +
                     std::to_string(steps + 5))
                  .code,
              0);
    fs::remove_all(folder_ / "cut");
  }
}

TEST_F(Cli, ACheckpointThatDoesNotFitIsRefused) {
  write("pulled.json", kPulled);
  write("layers.json", kLayers);
  ASSERT_EQ(icloth("run pulled.json --device cpu --steps 12 --checkpoint state --quiet").code, 0);
  const std::string resume = " --device cpu --steps 20 --quiet --resume ";
  expect_bad_input("run layers.json" + resume + "state", "another start state");
  expect_bad_input("run pulled.json --precision f64" + resume + "state", "expected cpu64");
  expect_bad_input("run pulled.json" + resume + "pulled.json", "expected a checkpoint");
  expect_bad_input("run pulled.json" + resume + "none", "none");

  // Cut off or damaged at any place it is refused as well.
  const std::string whole = read(folder_ / "state");
  for (const std::size_t cut :
       {std::size_t{0}, std::size_t{10}, std::size_t{60}, whole.size() / 2, whole.size() - 1}) {
    write("cut", whole.substr(0, cut));
    expect_bad_input("run pulled.json" + resume + "cut", "cut: ");
  }
  for (const std::size_t place : {std::size_t{25}, std::size_t{200}, whole.size() - 100}) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x15);
    write("cut", damaged);
    expect_bad_input("run pulled.json" + resume + "cut", "");
  }

  // A run that cannot be resumed leaves what is there as it is.
  ASSERT_EQ(
      icloth("run layers.json --device cpu --steps 30 --quiet --stats layers.csv --out out").code,
      0);
  const std::string rows = read(folder_ / "layers.csv"), list = read(folder_ / "out/frames.csv");
  expect_bad_input("run layers.json" + resume + "state --stats layers.csv --out out",
                   "another start state");
  EXPECT_EQ(read(folder_ / "layers.csv"), rows);
  EXPECT_EQ(read(folder_ / "out/frames.csv"), list);

  // Statistics of other steps are not written over.
  write("other.csv", "step,time\n1,0.1\n");
  expect_bad_input("run pulled.json" + resume + "state --stats other.csv", "other columns");
}

}  // namespace
}  // namespace icloth::testing
