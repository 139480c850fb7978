// A simulation on the device takes its memory at the start: no step waits for more, neither while
// nothing changes nor when cloth touches something for the first time.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kernels/parallel/profile.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/cuda_on_host/device/counts.h"

namespace icloth {
namespace {

using cuda_on_host::counts;

/// Runs the scene on the device and counts what every step takes from it.
struct MemoryRun {
  std::vector<long> taken;         ///< calls that took memory from the device, of each step
  std::int64_t grown = 0;          ///< times, as the profile notes
  std::int64_t most_contacts = 0;  ///< pairs in proximity

  MemoryRun(const std::string& scene_name, const std::vector<std::string>& overrides, int steps) {
    const auto scene = load_scene(scene_name, overrides);
    const auto simulator = make_simulator(Build::cuda32, scene);
    ScriptedInput script(*scene);

    // The profile is where a simulator notes that its reserve did not do.
    profile_reset();
    profile_enable(true);
    for (int k = 0; k < steps; ++k) {
      const long before = counts().allocations;
      const auto events = script.events(simulator->time(), scene->parameters.step.time_step);
      const StepReport report = simulator->step(events);
      taken.push_back(counts().allocations - before);
      most_contacts = std::max(most_contacts, report.proximity_pairs);
    }
    profile_enable(false);

    for (const ProfileRow& row : profile_rows())
      if (row.name == "memory.grow") grown = row.calls;
  }
  long taken_after(std::size_t step) const {
    long sum = 0;
    for (std::size_t k = step; k < taken.size(); ++k) sum += taken[k];
    return sum;
  }
};

// The first step makes what a thread keeps between its calls, a few numbers in memory of its own.

TEST(SteadyMemory, AFallingScarfTakesNothing) {
  const MemoryRun run("scarf", {"triangles=200"}, 12);
  EXPECT_EQ(run.taken_after(1), 0);
  EXPECT_EQ(run.grown, 0);
}

TEST(SteadyMemory, AFirstTouchTakesNothing) {
  const MemoryRun run("sphere", {"triangles=250"}, 50);
  EXPECT_GT(run.most_contacts, 50);
  EXPECT_EQ(run.taken_after(1), 0);
  EXPECT_EQ(run.grown, 0);
}

TEST(SteadyMemory, ImpactZonesTakeNothing) {
  const MemoryRun run(ICLOTH_TEST_FOLDER "/data/drop.json",
                      {"gravity.y=-100", "proximity.enabled=false"}, 8);
  EXPECT_EQ(run.taken_after(1), 0);
  EXPECT_EQ(run.grown, 0);
}

/// Memory is reserved for some candidates a vertex; a thick sheet has more, and the profile notes
/// it.
TEST(SteadyMemory, MoreThanWasReservedIsTakenOnceAndNoted) {
  const MemoryRun run(ICLOTH_TEST_FOLDER "/data/drop.json",
                      {"triangles=3000", "proximity.thickness=0.05"}, 2);
  EXPECT_GT(run.grown, 0);
  EXPECT_GT(run.taken_after(0), 0);
}

}  // namespace
}  // namespace icloth
