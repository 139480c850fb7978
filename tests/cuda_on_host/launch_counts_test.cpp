// What a step asks of the device: launches, waits of the host and barriers of the whole grid. On a
// GPU small scenes take as long as these, whatever they compute.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/cuda_on_host/device/counts.h"

namespace icloth {
namespace {

using cuda_on_host::Counts;
using cuda_on_host::counts;

/// What one step asked for.
struct StepCounts {
  StepReport report;
  long launches, library_calls, host_waits, uploads, grid_barriers, allocations;
};

StepCounts difference(const StepReport& report, const Counts& before, const Counts& after) {
  return {.report = report,
          .launches = after.launches - before.launches,
          .library_calls = after.library_calls - before.library_calls,
          .host_waits = after.host_waits - before.host_waits,
          .uploads = after.uploads - before.uploads,
          .grid_barriers = after.grid_barriers - before.grid_barriers,
          .allocations = after.allocations - before.allocations};
}

/// Steps of the scarf with 10K triangles while it lies on the bust and itself. The processor goes
/// there, and the device takes over.
std::vector<StepCounts> steps_of_the_scarf(int first, int steps) {
  const auto scene = load_scene("scarf", {});
  const double dt = scene->parameters.step.time_step;
  ScriptedInput script(*scene);
  const auto on_processor = make_simulator(Build::cpu32, scene);
  for (int k = 0; k < first; ++k) on_processor->step(script.events(on_processor->time(), dt));

  const auto on_device = make_simulator(Build::cuda32, scene);
  on_device->restore(on_processor->snapshot());
  std::vector<StepCounts> result;
  for (int k = 0; k < steps; ++k) {
    const auto events = script.events(on_device->time(), dt);
    const Counts before = counts();
    const StepReport report = on_device->step(events);
    result.push_back(difference(report, before, counts()));
  }
  return result;
}

TEST(LaunchCounts, OfAScarfInContact) {
  long barriers = 0;
  std::int64_t iterations = 0, solves = 0;
  constexpr int kSteps = 6;
  for (const StepCounts& step : steps_of_the_scarf(300, kSteps)) {
    const StepReport& r = step.report;
    std::printf(
        "step %lld: %ld launches, %ld library calls, %ld waits, %ld uploads, %ld grid barriers, "
        "%ld allocations; %lld linearisations, %lld solves, %lld iterations, %lld impacts, "
        "%lld contacts\n",
        static_cast<long long>(r.step), step.launches, step.library_calls, step.host_waits,
        step.uploads, step.grid_barriers, step.allocations,
        static_cast<long long>(r.newton_iterations), static_cast<long long>(r.linear_solves),
        static_cast<long long>(r.cg_iterations), static_cast<long long>(r.impacts_first),
        static_cast<long long>(r.proximity_pairs));
    EXPECT_TRUE(r.accepted);
    EXPECT_GT(r.proximity_pairs, 1000);
    barriers += step.grid_barriers;
    iterations += r.cg_iterations;
    solves += r.linear_solves;
  }
  ASSERT_GT(iterations, 0);

  // An iteration waits for the couplings, the product, the residual, the levels, the correction and
  // the direction. A solve waits for a few more loops at its start and end, and a step for the
  // levels of the trees that are refitted.
  constexpr double kOfAnIteration = 6, kOfASolve = 14, kOfAStep = 30;
  EXPECT_LE(static_cast<double>(barriers), kOfAnIteration * static_cast<double>(iterations) +
                                               kOfASolve * static_cast<double>(solves) +
                                               kOfAStep * kSteps);
}

}  // namespace
}  // namespace icloth
