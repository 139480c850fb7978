// Speed against error: fronts, distances between runs, areas seen from above.
#include <gtest/gtest.h>

#include <numbers>

#include "app/suites/bench/trial.h"
#include "app/suites/validation/shadow.h"
#include "sim/scene/presets.h"

namespace icloth {
namespace {

TEST(ParetoFront, HoldsThePointsThatNoOtherBeats) {
  const std::vector<std::pair<double, double>> points = {{1, 9}, {2, 5}, {3, 5},  {4, 1},
                                                         {4, 2}, {5, 1}, {9, 0.5}};
  const std::vector<bool> expected = {true, true, false, true, false, false, true};
  EXPECT_EQ(pareto_front(points), expected);
  EXPECT_EQ(pareto_front({{1, 1}, {1, 1}}), (std::vector<bool>{true, true})) << "equal points stay";
  EXPECT_TRUE(pareto_front({}).empty());
}

Trial trial_of(Vec3d moved, Vec3d faster, double energy) {
  Trial trial;
  trial.mass = {1, 3};
  for (int k = 0; k < 2; ++k) {
    Sample s;
    s.positions = {moved, Vec3d{1, 0, 0} + moved};
    s.velocities = {Vec3d{0, -2, 0} + faster, Vec3d{0, -2, 0} + faster};
    s.kinetic = 8;
    s.elastic = energy;
    trial.samples.push_back(s);
  }
  trial.shadow = 2 + energy;
  return trial;
}

TEST(Trial, DistancesAreThoseThatWereMade) {
  const Trial reference = trial_of({}, {}, 0);
  const Errors same = compare(reference, reference, 2);
  EXPECT_EQ(same.position, 0);
  EXPECT_EQ(same.energy, 0);
  EXPECT_EQ(same.momentum, 0);
  const Errors errors = compare(trial_of({0, 0.3, 0.4}, {0, 0.1, 0}, 0.4), reference, 2);
  EXPECT_NEAR(errors.position, 0.5, 1e-12);
  EXPECT_NEAR(errors.momentum, 0.4 / 8, 1e-12) << "4 kg × 0.1 m/s of 4 kg × 2 m/s";
  EXPECT_NEAR(errors.energy, 0.4 / 8, 1e-12);
  EXPECT_NEAR(errors.shadow, 0.2, 1e-12);
}

TEST(Trial, PositionsAreComparedWhileTheyAreAlike) {
  const Trial reference = trial_of({}, {}, 0);
  Trial late = reference;
  late.samples[1].positions[0].x = 7;
  EXPECT_EQ(compare(late, reference, 1).position, 0);
  EXPECT_GT(compare(late, reference, 2).position, 1);
  Trial finer = reference;
  finer.mass.push_back(1);
  EXPECT_EQ(compare(finer, reference, 2).position, -1) << "another mesh";
}

TEST(Trial, RunsASceneAndComesNearerWithASmallerStep) {
  const TrialScene scene{"flag", 200, {"material.damping=0.002"}, 0.05, 2, 2};
  const Trial reference = run_trial(scene, {"step.time_step=0.001"}, Build::cpu64);
  const Trial coarse = run_trial(scene, {"step.time_step=0.025"}, Build::cpu32);
  const Trial fine = run_trial(scene, {"step.time_step=0.005"}, Build::cpu32);
  EXPECT_TRUE(coarse.finished && fine.finished);
  EXPECT_EQ(fine.penetrations, 0u);
  EXPECT_EQ(fine.samples.size(), 2u);
  EXPECT_GT(fine.seconds, 0);
  EXPECT_GT(fine.strain, 0);
  EXPECT_TRUE(same_run(fine, run_trial(scene, {"step.time_step=0.005"}, Build::cpu32)));
  EXPECT_FALSE(same_run(fine, coarse));
  Trial searched = fine;  // to the same end, with a solve more
  searched.solves += 1;
  EXPECT_FALSE(same_run(fine, searched));
  const Errors far = compare(coarse, reference, 2), near = compare(fine, reference, 2);
  EXPECT_GT(near.position, 0);
  EXPECT_LT(2 * near.position, far.position);
  EXPECT_THROW(run_trial(scene, {"step.time_step=0.03"}, Build::cpu32), std::exception)
      << "does not divide the interval";
}

TEST(Presets, AllSetTheSameParametersWithinTheirRanges) {
  ASSERT_EQ(presets().size(), 3u);
  for (const Preset& preset : presets()) {
    Parameters parameters;
    apply_preset(parameters, preset);
    EXPECT_TRUE(is_set(parameters, preset));
    EXPECT_FALSE(preset.purpose.empty());
    const std::string results = measured_results(preset);
    EXPECT_NE(results.find("sphere: "), std::string::npos) << results;
    EXPECT_NE(results.find("commit"), std::string::npos) << results;
    ASSERT_EQ(preset.settings.size(), presets()[0].settings.size());
    for (std::size_t k = 0; k < preset.settings.size(); ++k)
      EXPECT_EQ(preset.settings[k].first, presets()[0].settings[k].first);
  }
}

TEST(Shadow, CountsWhatIsCoveredOnce) {
  validation::Shadow ground({-1, -1}, {1, 1}, 0.005);
  EXPECT_EQ(ground.area(), 0);
  const std::vector<Vec3d> square = {{0, 1, 0}, {0.5, 2, 0}, {0.5, 3, 0.5}, {0, 4, 0.5}};
  ground.add(square, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_NEAR(ground.area(), 0.25, 0.003);
  ground.add(square, {{2, 1, 0}, {0, 1, 3}});  // seen from below, and over it again
  EXPECT_NEAR(ground.area(), 0.25, 0.003);
  ground.add_disc({-0.5, -0.5}, 0.3);
  EXPECT_NEAR(ground.area(), 0.25 + std::numbers::pi * 0.09, 0.006);
  ground.add({{9, 0, 9}, {10, 0, 9}, {9, 0, 10}}, {{0, 1, 2}});  // outside
  EXPECT_NEAR(ground.area(), 0.25 + std::numbers::pi * 0.09, 0.006);
}

}  // namespace
}  // namespace icloth
