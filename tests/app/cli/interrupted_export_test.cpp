// An export that is killed, ended by a signal or stopped by a full disk, at random moments: all
// frames that frames.csv lists are whole in every format, with the bytes of an undisturbed run.
//
// ICLOTH_MOMENTS=10 tries so many moments of each kind, ICLOTH_SEED=N other ones.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <random>
#include <sstream>
#include <thread>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/state/checkpoint.h"
#include "tests/app/cli/program.h"
#include "tests/support/usda_reader.h"

namespace icloth::testing {
namespace {

/// A sheet that falls on a ball that moves.
constexpr const char* kFall = R"({
  "name": "fall", "time_step": 0.01, "duration": 1,
  "cloths": [ { "name": "sheet", "mesh": { "grid": { "size": [0.3, 0.3],
                "orientation": "horizontal" } }, "triangles": 800,
                "transform": { "translate": [0, 0.12, 0] } } ],
  "obstacles": [ { "name": "ball", "mesh": { "sphere": { "radius": 0.1, "triangles": 300 } },
                   "motion": [ { "time": 0, "translate": [0, 0, 0] },
                               { "time": 1, "translate": [0.1, 0, 0] } ] } ]
})";

const std::vector<std::string> kObjects = {"cloth_sheet", "obstacle_ball"};

int number_of(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::vector<std::string> lines;
  std::string text = read(path);
  for (std::size_t end = 0; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
    lines.push_back(text.substr(0, end));
  return lines;
}

/// What is done to the program.
struct Disturbance {
  double after = 1e9;              ///< [s]
  int signal = 0;                  ///< that is sent then
  rlim_t largest = RLIM_INFINITY;  ///< file that it may write [bytes]
};

/// Programs that end at random moments.
class Interrupted : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    write("fall.json", kFall);
    const unsigned seed = static_cast<unsigned>(number_of("ICLOTH_SEED", 19));
    random_.seed(seed);
    std::printf("ICLOTH_SEED=%u\n", seed);
  }

  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }

  /// Returns the exit code, or −signal.
  int run_program(const std::string& line, const Disturbance& disturbance) {
    std::vector<std::string> words = {ICLOTH_PROGRAM};
    std::istringstream rest(line);
    for (std::string word; rest >> word;) words.push_back(word);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    // After the fork the child calls nothing that takes memory.
    const std::string err = (folder_ / "err").string();
    const pid_t child = fork();
    if (child == 0) {
      // The new program has the usual signals, and writes beside the scene.
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
      const rlimit limit{disturbance.largest, disturbance.largest};
      if (disturbance.largest != RLIM_INFINITY) setrlimit(RLIMIT_FSIZE, &limit);
      const int file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      dup2(file, STDERR_FILENO);
      if (chdir(folder_.c_str()) == 0) execv(arguments[0], arguments.data());
      _exit(127);
    }

    // The moment is waited for, unless the program ends before.
    const auto start = std::chrono::steady_clock::now();
    int status = 0;
    for (bool sent = false; waitpid(child, &status, WNOHANG) == 0;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
      if (disturbance.signal != 0 && !sent && passed.count() >= disturbance.after) {
        kill(child, disturbance.signal);
        sent = true;
      }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  std::mt19937 random_;
};

/// Exports of all formats, with one that nothing disturbs to compare with.
class InterruptedExport : public Interrupted {
 protected:
  void SetUp() override {
    Interrupted::SetUp();

    // The whole run says how long one takes, and what its frames are.
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(run("whole", "whole.state", {}), 0) << read(folder_ / "err");
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    rows_ = lines_of(folder_ / "whole" / "frames.csv");
    ASSERT_EQ(rows_.size(), 1u + kFrames);
    for (const std::string& name : kObjects)
      caches_.push_back(
          read_point_cache((folder_ / "whole" / (name + ".pc2")).string(), vertices(name)));
    expect_whole("whole");
  }

  Index vertices(const std::string& name) const {
    const fs::path file = folder_ / "whole" / (name + ".obj");
    return static_cast<Index>(read_mesh(file.string()).mesh.positions.size());
  }

  /// Runs the scene with all formats into a folder. Returns the exit code, or −signal.
  int run(const std::string& out, const std::string& state, const Disturbance& disturbance) {
    const std::string line =
        "run fall.json --quiet --device cpu --threads 1 --steps 99 --every 3 --export obj "
        "--export ply --export pc2 --export mdd --export usda --checkpoint-every 2 --out ";
    return run_program(line + out + " --checkpoint " + state, disturbance);
  }

  /// Reads everything back that a run left. Returns the number of frames that its list names.
  std::size_t expect_whole(const std::string& out) {
    const fs::path folder = folder_ / out;

    // All rows are those of the whole run, but for a last state between two frames.
    std::vector<std::string> rows = lines_of(folder / "frames.csv");
    std::size_t even = 0;
    for (std::size_t row = 1; row < rows.size(); ++row) {
      const bool is_last_state = row >= rows_.size() || rows[row] != rows_[row];
      if (is_last_state) {
        EXPECT_EQ(row, rows.size() - 1) << rows[row];
        expect_last_state(folder, row - 1);
      } else {
        expect_frame(folder, even++);
      }
    }
    expect_caches(folder, even);
    expect_conversion(folder, even);
    return rows.empty() ? 0 : rows.size() - 1;
  }

  /// A state that the whole run does not have is the same in both mesh formats.
  void expect_last_state(const fs::path& folder, std::size_t frame) const {
    const std::string name = (folder / name_of(frame)).string();
    const std::vector<Vec3d> obj = read_mesh(name + ".obj").mesh.positions,
                             ply = read_mesh(name + ".ply").mesh.positions;
    ASSERT_EQ(obj.size(), ply.size());
    for (std::size_t v = 0; v < obj.size(); ++v)
      ASSERT_EQ(convert<float>(obj[v]), convert<float>(ply[v])) << name << ": vertex " << v;
    EXPECT_EQ(read(folder / "last.obj"), read(name + ".obj"));
  }

  static std::string name_of(std::size_t frame) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05zu", frame);
    return name;
  }

  /// The mesh files of a frame have the bytes of the whole run, and the places of its caches.
  void expect_frame(const fs::path& folder, std::size_t frame) const {
    for (const char* extension : {".obj", ".ply"}) {
      const fs::path file = folder / (name_of(frame) + extension);
      EXPECT_EQ(read(file), read(folder_ / "whole" / file.filename())) << file;

      // Objects follow each other in the order of their caches.
      const std::vector<Vec3d> places = read_mesh(file.string()).mesh.positions;
      std::size_t v = 0;
      for (const PointCache& cache : caches_)
        for (const Vec3f place : cache.frames[frame]) {
          ASSERT_LT(v, places.size());
          ASSERT_EQ(convert<float>(places[v]), place) << file << ": vertex " << v;
          ++v;
        }
      EXPECT_EQ(v, places.size());
    }
  }

  /// Caches hold at least so many frames.
  void expect_caches(const fs::path& folder, std::size_t frames) const {
    for (std::size_t i = 0; frames > 0 && i < kObjects.size(); ++i) {
      const PointCache cache =
          read_point_cache((folder / (kObjects[i] + ".pc2")).string(), vertices(kObjects[i]));
      ASSERT_GE(cache.frames.size(), frames);
      for (std::size_t f = 0; f < frames; ++f) ASSERT_EQ(cache.frames[f], caches_[i].frames[f]);
    }
  }

  /// `icloth export` makes MDD and USDA of what is there, with the bytes that a run writes itself.
  void expect_conversion(const fs::path& folder, std::size_t frames) {
    const fs::path made = folder_ / "made";
    fs::remove_all(made);
    const Outcome outcome = icloth("export '" + folder.string() + "' --out made");
    if (frames == 0) {
      EXPECT_EQ(outcome.code, 2) << outcome.err;
      EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
      return;
    }
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    if (fs::exists(folder / "scene.usda")) {
      for (const char* file : {"scene.usda", "cloth_sheet.mdd", "obstacle_ball.mdd"})
        EXPECT_EQ(read(folder / file), read(made / file)) << file;
    }

    // Both hold the frames of the caches, bit for bit.
    const std::string text = read(made / "scene.usda");
    const UsdaStage stage = UsdaReader(text).read();
    for (std::size_t i = 0; i < kObjects.size(); ++i) {
      const PointCache mdd =
          read_point_cache((made / (kObjects[i] + ".mdd")).string(), vertices(kObjects[i]));
      ASSERT_EQ(mdd.frames.size(), frames);
      const auto& samples = stage.meshes.at("\"" + kObjects[i] + "\"").samples.at("points");
      ASSERT_EQ(samples.size(), frames);
      for (std::size_t f = 0; f < frames; ++f) {
        ASSERT_EQ(mdd.frames[f], caches_[i].frames[f]);
        const std::vector<double>& points = samples.at(static_cast<double>(f));
        ASSERT_EQ(points.size(), 3 * mdd.frames[f].size());
        for (std::size_t v = 0; v < mdd.frames[f].size(); ++v)
          ASSERT_EQ((Vec3f{static_cast<float>(points[3 * v]), static_cast<float>(points[3 * v + 1]),
                           static_cast<float>(points[3 * v + 2])}),
                    mdd.frames[f][v]);
      }
    }
  }

  /// A checkpoint is whole, where there is one, and the one of the last step but a few.
  void expect_checkpoint(const std::string& state, std::size_t frames) const {
    const fs::path file = folder_ / state;
    if (!fs::exists(file)) return;
    std::int64_t steps = 0;
    ASSERT_NO_THROW(steps = load_checkpoint(file.string()).steps());
    EXPECT_GE(steps + 4, 3 * (static_cast<std::int64_t>(frames) - 1));
  }

  /// One line says what could not be written, and nothing half is left behind.
  void expect_full_disk(const std::string& out, int code) const {
    const std::string err = read(folder_ / "err");
    EXPECT_EQ(code, 2) << err;
    EXPECT_EQ(count_lines(err), 1u) << err;
    EXPECT_TRUE(contains(err, "cannot be written") || contains(err, "cannot be made")) << err;
    if (!fs::exists(folder_ / out)) return;
    for (const auto& entry : fs::directory_iterator(folder_ / out))
      EXPECT_FALSE(contains(entry.path().filename().string(), ".tmp")) << entry.path();
  }

  void tell(const char* what, double moment, int code, std::size_t frames) const {
    std::printf("  %s at %.4g: exit %d, %zu of %zu frames\n", what, moment, code, frames, kFrames);
    std::fflush(stdout);
  }

  static constexpr std::size_t kFrames = 34;
  double seconds_ = 0;             ///< of an undisturbed run
  std::vector<std::string> rows_;  ///< of its list
  std::vector<PointCache> caches_;
};

TEST_F(InterruptedExport, WhatWasListedBeforeAKillIsWhole) {
  for (int i = 0; i < number_of("ICLOTH_MOMENTS", 2); ++i) {
    const double moment = uniform(0, 1.1 * seconds_);
    const int code = run("out", "out.state", {.after = moment, .signal = SIGKILL});
    const std::size_t frames = expect_whole("out");
    expect_checkpoint("out.state", frames);
    tell("killed", moment, code, frames);
    fs::remove_all(folder_ / "out");
    fs::remove(folder_ / "out.state");
  }
}

TEST_F(InterruptedExport, WhatWasListedBeforeASignalIsWhole) {
  for (int i = 0; i < number_of("ICLOTH_MOMENTS", 2); ++i) {
    const double moment = uniform(0, seconds_);
    const int code = run("out", "out.state", {.after = moment, .signal = SIGINT});
    const std::size_t frames = expect_whole("out");
    expect_checkpoint("out.state", frames);
    tell("SIGINT", moment, code, frames);

    // A run that began to step ends in order, with all files that it was asked for.
    if (contains(read(folder_ / "err"), "ended by SIGINT")) {
      EXPECT_EQ(code, 1);
      EXPECT_TRUE(fs::exists(folder_ / "out" / "scene.usda"));
      EXPECT_TRUE(fs::exists(folder_ / "out" / "last.obj"));
    }
    fs::remove_all(folder_ / "out");
    fs::remove(folder_ / "out.state");
  }
}

TEST_F(InterruptedExport, WhatWasListedBeforeAFileCouldNotGrowIsWhole) {
  const auto size = [&](const char* file) {
    return static_cast<double>(fs::file_size(folder_ / "whole" / file));
  };
  const double least = 0.9 * size("frame_00000.obj"), most = 2 * size("cloth_sheet.pc2");
  for (int i = 0; i < number_of("ICLOTH_MOMENTS", 2); ++i) {
    // A cache grows to its limit on the way, the scene of USDA at the end.
    const double bytes = uniform(least, most);
    const int code = run("out", "out.state", {.largest = static_cast<rlim_t>(bytes)});
    const std::size_t frames = expect_whole("out");
    expect_checkpoint("out.state", frames);
    expect_full_disk("out", code);
    tell("files limited to bytes", bytes, code, frames);
    fs::remove_all(folder_ / "out");
    fs::remove(folder_ / "out.state");
  }
}

/// A small disk of its own, gone with the thread that made it.
bool mount_small_disk(const fs::path& folder, std::size_t bytes) {
  const std::string size = "size=" + std::to_string(bytes);
  return mount("icloth-test", folder.c_str(), "tmpfs", 0, size.c_str()) == 0;
}

TEST_F(InterruptedExport, WhatWasListedBeforeTheDiskWasFullIsWhole) {
  // In a name space of its own, the disk is seen by nobody else and goes with the program.
  if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
    GTEST_SKIP() << "no small disk can be mounted: " << std::strerror(errno);
  std::uintmax_t all = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "whole")) all += entry.file_size();
  fs::create_directory(folder_ / "disk");

  for (int i = 0; i < number_of("ICLOTH_MOMENTS", 2); ++i) {
    const double bytes = uniform(0, 0.7 * static_cast<double>(all));
    if (!mount_small_disk(folder_ / "disk", static_cast<std::size_t>(bytes)))
      GTEST_SKIP() << "no small disk can be mounted: " << std::strerror(errno);
    const int code = run("disk/out", "disk/state", {});
    const std::size_t frames = expect_whole("disk/out");
    expect_checkpoint("disk/state", frames);
    expect_full_disk("disk/out", code);
    tell("disk of bytes", bytes, code, frames);
    ASSERT_EQ(umount((folder_ / "disk").c_str()), 0) << std::strerror(errno);
  }
}

TEST_F(Interrupted, ACheckpointIsWholeAtEveryMoment) {
  // Every step writes one, and a row of statistics before it.
  const std::string line =
      "run fall.json --quiet --device cpu --set triangles=5000 --checkpoint state "
      "--checkpoint-every 1 --stats rows.csv --steps ";
  for (int i = 0; i < number_of("ICLOTH_MOMENTS", 2); ++i) {
    const double moment = uniform(0.3, 1.2);
    const int code = run_program(line + "5000", {.after = moment, .signal = SIGKILL});
    EXPECT_EQ(code, -SIGKILL);
    const std::vector<std::string> rows = lines_of(folder_ / "rows.csv");
    std::int64_t steps = 0;
    if (fs::exists(folder_ / "state")) {
      ASSERT_NO_THROW(steps = load_checkpoint((folder_ / "state").string()).steps());
    }

    // The step of the last row may be the one whose checkpoint was being written.
    EXPECT_GE(steps + 2, static_cast<std::int64_t>(rows.size()));
    std::printf("  killed at %.4g s: checkpoint of step %lld, %zu rows\n", moment,
                static_cast<long long>(steps), rows.size());

    // What was being written when the program was killed lies beside.
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().filename().string().starts_with("state")) fs::remove(entry.path());
  }

  // A disk that is full keeps the one before: the file grows with the input that it holds.
  ASSERT_EQ(run_program(line + "4", {}), 0) << read(folder_ / "err");
  const auto bytes = static_cast<rlim_t>(fs::file_size(folder_ / "state"));
  EXPECT_EQ(run_program(line + "5000", {.largest = bytes + 20}), 2);
  EXPECT_EQ(count_lines(read(folder_ / "err")), 1u) << read(folder_ / "err");
  EXPECT_GE(load_checkpoint((folder_ / "state").string()).steps(), 4);
  EXPECT_EQ(std::ranges::count_if(fs::directory_iterator(folder_),
                                  [](const auto& entry) {
                                    return contains(entry.path().filename().string(), ".tmp");
                                  }),
            0);
}

}  // namespace
}  // namespace icloth::testing
