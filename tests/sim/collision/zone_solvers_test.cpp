// The three solvers of impact zones in every build.
#include "tests/sim/collision/zone_solvers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "sim/simulator.h"

namespace icloth {
namespace {

using testing::ZoneOutcome;

ZoneOutcome solve(Build build, ZoneSolver solver, bool large) {
  if (build == Build::cpu32)
    return large ? cpu32::solve_large_zone(solver) : cpu32::solve_small_zones(solver);
#if defined(ICLOTH_HAS_CUDA)
  if (build == Build::cuda32)
    return large ? cuda32::solve_large_zone(solver) : cuda32::solve_small_zones(solver);
#endif
  return large ? cpu64::solve_large_zone(solver) : cpu64::solve_small_zones(solver);
}

double largest_distance(const ZoneOutcome& a, const ZoneOutcome& b) {
  double most = 0;
  EXPECT_EQ(a.x1.size(), b.x1.size());
  for (std::size_t i = 0; i < std::min(a.x1.size(), b.x1.size()); ++i)
    most = std::max(most, norm(a.x1[i] - b.x1[i]));
  return most;
}

class ZoneSolvers : public ::testing::TestWithParam<std::tuple<Build, ZoneSolver>> {
 protected:
  void SetUp() override {
    std::string reason;
    if (!build_available(build(), &reason)) GTEST_SKIP() << reason;
  }
  static Build build() { return std::get<0>(GetParam()); }
  static ZoneSolver solver() { return std::get<1>(GetParam()); }

  /// Every impact has to be open behind the solve; cuda32 only adds up in another order than cpu32.
  static void check(const ZoneOutcome& found, bool large) {
    EXPECT_GT(found.impacts, 200u);
    EXPECT_GE(found.smallest_gap, 0.79);
    if (build() == Build::cuda32) {
      EXPECT_LT(largest_distance(found, solve(Build::cpu32, solver(), large)), 1e-6);
    }
  }
};

std::string name_of(const ::testing::TestParamInfo<std::tuple<Build, ZoneSolver>>& instance) {
  const auto [build, solver] = instance.param;
  const char* const name = solver == ZoneSolver::augmented_lagrangian ? "augmented_lagrangian"
                           : solver == ZoneSolver::dual               ? "dual"
                                                                      : "linear";
  return std::string(build_name(build)) + "_" + name;
}

INSTANTIATE_TEST_SUITE_P(
    All, ZoneSolvers,
    ::testing::Combine(::testing::Values(Build::cpu32, Build::cpu64, Build::cuda32),
                       ::testing::Values(ZoneSolver::augmented_lagrangian, ZoneSolver::dual,
                                         ZoneSolver::linear)),
    name_of);

TEST_P(ZoneSolvers, OpenEveryImpactOfSmallZones) {
  const ZoneOutcome found = solve(build(), solver(), false);
  EXPECT_FALSE(found.by_device);
  check(found, false);
}

TEST_P(ZoneSolvers, OpenEveryImpactOfALargeZone) {
  const ZoneOutcome found = solve(build(), solver(), true);
  EXPECT_TRUE(found.by_device);
  check(found, true);
}

}  // namespace
}  // namespace icloth
