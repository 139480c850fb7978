// Small runs of all built-in scenes, and of one with impact zones and retries, on the emulated
// device: step by step the state of cpu32, in every order of threads and blocks.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "kernels/parallel/profile.h"
#include "sim/files/assets.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/cuda_on_host/device/race_detector.h"
#include "tests/cuda_on_host/device/settings.h"

namespace icloth {
namespace {

using cuda_on_host::Order;
using cuda_on_host::Settings;
using cuda_on_host::settings;

/// A run: what load_scene takes, and its number of steps.
struct Case {
  std::string scene;
  std::vector<std::string> overrides;
  int steps = 10;
};

/// The outcome of a run, as the tests look at it.
struct Outcome {
  std::vector<std::uint64_t> hashes;  ///< after each step
  int refused = 0;                    ///< steps
  std::int64_t retries = 0, impacts = 0, rounds = 0;
  std::int64_t contacts = 0;  ///< most that a step had
};

Outcome run(Build build, const Case& given) {
  const auto scene = load_scene(given.scene, given.overrides);
  const auto simulator = make_simulator(build, scene);
  ScriptedInput script(*scene);

  // As a headless run does it, with the hands of the scene.
  Outcome outcome;
  for (int k = 0; k < given.steps; ++k) {
    const auto events = script.events(simulator->time(), scene->parameters.step.time_step);
    const StepReport report = simulator->step(events);
    outcome.hashes.push_back(report.state_hash);
    outcome.refused += report.accepted ? 0 : 1;
    outcome.retries += report.retries;
    outcome.impacts += report.impacts_first;
    outcome.rounds += report.rounds;
    outcome.contacts = std::max(outcome.contacts, report.proximity_pairs);
  }
  return outcome;
}

/// Restores the settings behind each test.
class DeviceRuns : public ::testing::Test {
 protected:
  ~DeviceRuns() override { settings() = before_; }
  void compare(const Case& given, const Outcome& expected, const Settings& set) {
    settings() = set;
    settings().devices = before_.devices;
    const Outcome found = run(Build::cuda32, given);
    const auto differ = std::ranges::mismatch(expected.hashes, found.hashes);
    EXPECT_TRUE(differ.in1 == expected.hashes.end())
        << given.scene << ": another state after step " << differ.in1 - expected.hashes.begin() + 1
        << ", order " << static_cast<int>(set.order) << ", seed " << set.seed;
    EXPECT_EQ(expected.refused, found.refused);
  }

 private:
  const Settings before_ = settings();
};

// ---- the built-in scenes ------------------------------------------------------------------------

class Scenes : public DeviceRuns, public ::testing::WithParamInterface<std::string> {};

/// All without garments, which cannot be cut into as few triangles as these runs have.
std::vector<std::string> built_in_scenes() {
  std::istringstream text(asset_names("scenes"));
  std::vector<std::string> names{std::istream_iterator<std::string>(text), {}};
  for (const char* dressed : {"dressed", "dress", "tiered", "andy", "bishop"})
    std::erase(names, dressed);
  return names;
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Scenes, ::testing::ValuesIn(built_in_scenes()),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(Scenes, GiveTheStatesOfTheCpu) {
  const Case given{GetParam(), {"triangles=250"}, 25};
  const Outcome expected = run(Build::cpu32, given);
  compare(given, expected, {.order = Order::backward, .deferred = true});
}

// ---- impact zones, retries, roll-back -----------------------------------------------------------

/// The lines of tests/data/device_runs.txt, by their names.
std::map<std::string, Case> device_runs() {
  std::map<std::string, Case> runs;
  std::ifstream file(ICLOTH_TEST_FOLDER "/data/device_runs.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string name;
    Case& run = (words >> name, runs[name]);
    run.scene = ICLOTH_TEST_FOLDER "/data/drop.json";
    words >> run.steps;
    run.overrides.assign(std::istream_iterator<std::string>(words), {});
  }
  return runs;
}

/// Those settings with which a wrong kernel has most chances to give something else.
std::vector<Settings> watchful_settings() {
  return {{.order = Order::forward, .guarded = !cuda_on_host::kDetectsRaces},
          {.order = Order::backward, .poison = 0xff, .deferred = true},
          {.order = Order::random, .seed = 1, .processors = 1, .resident = 1, .poison = 0x00},
          {.order = Order::random, .seed = 2, .processors = 50, .poison = 0x7f},
          {.order = Order::random, .seed = 3, .deferred = true}};
}

TEST_F(DeviceRuns, ReachWhatTheyAreNamedAfter) {
  std::map<std::string, Case> runs = device_runs();
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_GT(run(Build::cpu32, runs["contacts"]).contacts, 100);

  const Outcome zones = run(Build::cpu32, runs["zones_and_retries"]);
  EXPECT_GT(zones.impacts, 1000);
  EXPECT_GT(zones.rounds, 10);
  EXPECT_GT(zones.retries, 1);

  profile_reset();
  profile_enable(true);
  EXPECT_EQ(run(Build::cpu32, runs["roll_back"]).refused, 0);
  profile_enable(false);
  const auto rolls_back = [](const ProfileRow& row) {
    return row.name == "impact_zones.roll_back";
  };
  EXPECT_TRUE(std::ranges::any_of(profile_rows(), rolls_back));
}

TEST_F(DeviceRuns, GiveTheStatesOfTheCpuInEveryOrder) {
  for (const auto& [name, given] : device_runs()) {
    SCOPED_TRACE(name);
    const Outcome expected = run(Build::cpu32, given);
    for (const Settings& set : watchful_settings()) compare(given, expected, set);
  }
}

TEST_F(DeviceRuns, EveryWayThroughTheStagesGivesTheStatesOfTheCpu) {
  for (const char* other :
       {"impact_zones.solver=linear", "impact_zones.solver=augmented_lagrangian",
        "broad_phase.method=hash", "ccd.incremental=false", "implicit.preconditioner=block_jacobi",
        "implicit.integrator=bdf2", "impact_zones.enabled=false"}) {
    SCOPED_TRACE(other);
    Case given = device_runs()["zones_and_retries"];
    given.steps = 7;
    given.overrides.push_back(other);
    compare(given, run(Build::cpu32, given), {.order = Order::random});
  }
}

}  // namespace
}  // namespace icloth
