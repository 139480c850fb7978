// Cloth at rest is left alone, and whatever could move it wakes it within a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "kernels/index.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::hanging;
using testing::make_obstacle;
using testing::make_sheet;

/// A small sheet that hangs by its upper edge in thick air, with a ball that moves after 40 s.
std::shared_ptr<Scene> hanging_scene(bool sleeps) {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->cloths.push_back(make_sheet(hanging(0.2, 60), {0, 0, 0}));
  scene->cloths[0].pins = grid_vertices(make_grid(hanging(0.2, 60)), "top");
  scene->obstacles.push_back(make_obstacle(make_sphere(0.05, 80), {}));
  scene->obstacles[0].motion = {{.time = 0, .translation = {0, 0, 0.3}, .rotation = {}},
                                {.time = 40, .translation = {0, 0, 0.3}, .rotation = {}},
                                {.time = 41, .translation = {0, 0, 0.2}, .rotation = {}}};
  scene->parameters.wind.air_density = 10;
  scene->parameters.material.damping = 0.05;
  scene->parameters.step.sleep = sleeps;
  return scene;
}

/// Steps until the time; returns whether the last one was slept through.
bool run_until(Simulator& simulator, double time) {
  bool asleep = false;
  while (simulator.time() < time) {
    const StepReport report = simulator.step({});
    EXPECT_TRUE(report.accepted);
    asleep = report.substeps == 0;
  }
  return asleep;
}

bool sleeps_through_step(Simulator& simulator, std::span<const InputEvent> events = {}) {
  const StepReport report = simulator.step(events);
  EXPECT_TRUE(report.accepted);
  return report.substeps == 0;
}

constexpr double kAsleep = 30;  // [s]

class Sleep : public ::testing::TestWithParam<Build> {
 protected:
  std::unique_ptr<Simulator> asleep() const {
    auto simulator = make_simulator(GetParam(), hanging_scene(true));
    EXPECT_TRUE(run_until(*simulator, kAsleep));
    return simulator;
  }
};

INSTANTIATE_TEST_SUITE_P(OfCloth, Sleep, ::testing::Values(Build::cpu32, Build::cpu64),
                         [](const auto& instance) {
                           return std::string(build_name(instance.param));
                         });

TEST_P(Sleep, ChangesTheClockAlone) {
  const auto simulator = asleep();
  const Snapshot before = simulator->snapshot();
  const std::uint64_t hash = simulator->state_hash();
  EXPECT_TRUE(sleeps_through_step(*simulator));
  const Snapshot after = simulator->snapshot();
  EXPECT_EQ(after.step, before.step + 1);
  EXPECT_GT(after.time, before.time);
  EXPECT_TRUE(after.x1 == before.x1);
  EXPECT_EQ(simulator->state_hash(), hash);
}

TEST_P(Sleep, ReportsTheStateThatItKeeps) {
  const auto simulator = asleep();
  StateReport measured;
  simulator->measure(measured);
  const StepReport asleep = simulator->step({});
  EXPECT_EQ(asleep.state_hash, measured.state_hash);
  EXPECT_EQ(asleep.kinetic_energy, measured.kinetic_energy);
  EXPECT_EQ(asleep.elastic_energy, measured.elastic_energy);
  EXPECT_EQ(asleep.gravity_energy, measured.gravity_energy);
  EXPECT_EQ(asleep.max_strain, measured.max_strain);
  EXPECT_EQ(asleep.max_speed, measured.max_speed);
  EXPECT_EQ(asleep.energy_balance, 0);
  EXPECT_GT(asleep.elastic_energy, 0);

  // Energies are left out as soon as nobody asks for them, and are back when somebody does.
  simulator->report_energies(false);
  EXPECT_EQ(simulator->step({}).elastic_energy, 0);
  simulator->report_energies(true);
  EXPECT_EQ(simulator->step({}).elastic_energy, asleep.elastic_energy);
}

TEST_P(Sleep, LeavesTheClothWhereItWouldGo) {
  const auto sleeping = asleep(), awake = make_simulator(GetParam(), hanging_scene(false));
  EXPECT_FALSE(run_until(*awake, kAsleep + 9));
  EXPECT_TRUE(run_until(*sleeping, kAsleep + 9));
  const std::vector<Vec3d> a = sleeping->snapshot().x1, b = awake->snapshot().x1;
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(norm(a[i] - b[i]), 2e-5) << i;
}

TEST_P(Sleep, EndsWithATouch) {
  const auto simulator = asleep();
  const Vec3d corner = simulator->snapshot().x1[0];
  const InputEvent grab{
      .kind = InputEvent::Kind::grab, .handle = 1, .target = corner + Vec3d{0, -0.1, 0.1}};
  EXPECT_FALSE(sleeps_through_step(*simulator, {&grab, 1}));
  EXPECT_FALSE(sleeps_through_step(*simulator)) << "the hand is still there";
}

TEST_P(Sleep, EndsWithAChangeOfWind) {
  const auto simulator = asleep();
  Parameters parameters = simulator->parameters();
  parameters.wind.z = 3;
  simulator->set_parameters(parameters);
  const std::vector<Vec3d> before = simulator->snapshot().x1;
  EXPECT_FALSE(sleeps_through_step(*simulator));
  EXPECT_FALSE(simulator->snapshot().x1 == before);
}

TEST_P(Sleep, EndsWhenABodyBeginsToMove) {
  // The clock adds up steps, so that 40 s may be met a little early.
  const auto simulator = asleep();
  EXPECT_TRUE(run_until(*simulator, 39.975));
  while (simulator->time() < 40.025) {
    const bool slept = sleeps_through_step(*simulator);
    EXPECT_TRUE(!slept || simulator->time() < 40.005) << simulator->time();
  }
}

TEST_P(Sleep, GoesOnFromASnapshot) {
  const auto simulator = asleep(), other = make_simulator(GetParam(), hanging_scene(true));
  other->restore(simulator->snapshot());
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(sleeps_through_step(*simulator));
    EXPECT_TRUE(sleeps_through_step(*other));
    EXPECT_EQ(simulator->state_hash(), other->state_hash());
  }
}

}  // namespace
}  // namespace icloth
