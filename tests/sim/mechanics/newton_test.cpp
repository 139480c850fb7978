// Newton's method, which renews the linearisation of the faces that need it, against the solution
// of the same step without any error of linearisation (double build).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

/// A sheet that lies still, but for a flap that turns fast about the line x = kFold.
constexpr double kFold = 0.05;

struct Step {
  std::vector<Vec3d> x;
  StepReport report;
};

Step step_of_the_flap(double newton_tolerance, int newton_iterations) {
  auto scene = std::make_shared<Scene>();
  scene->cloths.push_back(testing::make_sheet(testing::lying(0.3, 600), {}));
  Parameters& p = scene->parameters;
  p.wind.air_density = 0;
  p.gravity = {0, 0, 0};
  p.implicit.cg_tolerance = 1e-10;
  p.implicit.cg_max_iterations = 5000;
  p.implicit.newton_tolerance = newton_tolerance;
  p.implicit.newton_iterations = newton_iterations;
  p.implicit.max_linearization_error = 1e6;
  p.step.time_step = 0.005;
  p.step.max_travel = 100;
  const auto simulator = make_simulator(Build::cpu64, scene);

  // 40 rad/s are a fifth of a radian in a step.
  Snapshot state = simulator->snapshot();
  for (std::size_t i = 0; i < state.x1.size(); ++i)
    state.v[i] = {0, 40 * std::max(state.x1[i].x - kFold, 0.0), 0};
  simulator->restore(state);
  Step step;
  step.report = simulator->step({});
  EXPECT_TRUE(step.report.accepted);
  EXPECT_EQ(step.report.substeps, 1);
  step.x = simulator->snapshot().x1;
  return step;
}

double largest_difference(const Step& a, const Step& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i) most = std::max(most, norm(a.x[i] - b.x[i]));
  return most;
}

TEST(Newton, RenewingSomeFacesComesNearTheStepWithoutErrorsOfLinearisation) {
  const Step exact = step_of_the_flap(1e-7, 60);
  EXPECT_FALSE(exact.report.reached(Limit::newton_iterations));

  // One linearisation lets the turning flap grow; a few of some faces do not.
  const double once = largest_difference(step_of_the_flap(0.02, 1), exact);
  const Step usual = step_of_the_flap(0.02, 10);
  const double few = largest_difference(usual, exact);
  EXPECT_GT(usual.report.newton_iterations, 1);
  EXPECT_FALSE(usual.report.reached(Limit::newton_iterations));
  std::printf("one linearisation %.3g mm, %lld linearisations %.3g mm\n", 1e3 * once,
              static_cast<long long>(usual.report.newton_iterations), 1e3 * few);
  EXPECT_GT(once, 1e-3);
  EXPECT_LT(few, 0.04 * once);
}

/// Largest strain of a sheet that is pinned at its top and pulled down with 40 g, over a few steps.
/// Pressure does nothing to open cloth, but with it every linearisation renews all faces.
double strain_of_a_pulled_sheet(double pressure) {
  auto scene = std::make_shared<Scene>();
  const GridShape shape = testing::hanging(0.3, 400);
  scene->cloths.push_back(testing::make_sheet(shape, {}));
  scene->cloths[0].pins = grid_vertices(make_grid(shape), "top");
  Parameters& p = scene->parameters;
  p.wind.air_density = 0;
  p.gravity = {0, -400, 0};
  p.material.strain_limit = 0.03;
  p.material.pressure = pressure;
  const auto simulator = make_simulator(Build::cpu64, scene);
  double most = 0;
  for (int k = 0; k < 20; ++k) most = std::max(most, simulator->step({}).max_strain);
  return most;
}

TEST(Newton, RenewsFacesThatHardenAlways) {
  const double all = strain_of_a_pulled_sheet(1), some = strain_of_a_pulled_sheet(0);
  std::printf("all faces %.4f, those that need it %.4f\n", all, some);
  EXPECT_GT(all, 0.03);
  EXPECT_NEAR(some, all, 0.02 * all);
}

}  // namespace
}  // namespace icloth
