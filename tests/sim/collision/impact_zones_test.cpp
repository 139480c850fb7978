// Impact zones of crossing sheets: constraints, zones, momentum, threads.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include "sim/collision/impact_zones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "sim/simulator.h"
#include "tests/support/crossing.h"

namespace icloth::cpu32 {
namespace {

/// Zone of every cloth vertex, by a serial union-find; −1 for those without an impact.
std::vector<Index> union_find(const Stage& stage, const std::vector<Impact>& impacts) {
  std::vector<Index> parent(at(stage.world.cloth_vertices));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index i) {
    while (parent[at(i)] != i) i = parent[at(i)];
    return i;
  };
  std::vector<bool> used(parent.size());
  for (const Impact& impact : impacts) {
    Index first = -1;
    for (const Index v : impact.s.v) {
      if (v >= stage.world.cloth_vertices) continue;
      used[at(v)] = true;
      if (first >= 0) parent[at(root(v))] = root(first);
      first = v;
    }
  }
  for (Index i = 0; i < stage.world.cloth_vertices; ++i) {
    const Index r = root(i);
    parent[at(i)] = r;
  }
  for (std::size_t i = 0; i < parent.size(); ++i)
    if (!used[i]) parent[i] = -1;
  return parent;
}

class ImpactZoneSolvers : public ::testing::TestWithParam<ZoneSolver> {};
INSTANTIATE_TEST_SUITE_P(All, ImpactZoneSolvers,
                         ::testing::Values(ZoneSolver::augmented_lagrangian, ZoneSolver::dual,
                                           ZoneSolver::linear));

TEST(ImpactZones, AreTheConnectedComponents) {
  Crossing c(true);
  c.find();
  const std::vector<Impact> impacts = c.ccd.impacts().download();
  c.solve();
  std::map<Index, Index> size;
  for (const Index zone : union_find(c.stage, impacts))
    if (zone >= 0) ++size[zone];
  Index largest = 0;
  for (const auto& [zone, vertices] : size) largest = std::max(largest, vertices);
  EXPECT_GE(size.size(), 4u);
  EXPECT_EQ(c.stage.report.zones, static_cast<Index>(size.size()));
  EXPECT_EQ(c.stage.report.largest_zone, largest);
}

TEST(ImpactZones, MoveOnlyVerticesWithImpacts) {
  Crossing c(true);
  c.find();
  const std::vector<Index> zone = union_find(c.stage, c.ccd.impacts().download());
  const std::vector<Vec3r> before = c.stage.state.x1.download();
  c.solve();
  const std::vector<Vec3r> after = c.stage.state.x1.download();
  const View<const std::uint8_t> dirty = c.zones.dirty();
  double largest = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (i >= zone.size() || zone[i] < 0) {  // obstacles and vertices that touch nothing
      EXPECT_TRUE(after[i] == before[i]);
      EXPECT_TRUE(i >= zone.size() || dirty[static_cast<Index>(i)] == 0);
    } else {
      EXPECT_NE(dirty[static_cast<Index>(i)], 0);
    }
    largest = std::max(largest, norm(convert<double>(after[i]) - convert<double>(before[i])));
  }
  EXPECT_NEAR(static_cast<double>(c.zones.largest_correction()), largest, 1e-6);
}

TEST_P(ImpactZoneSolvers, KeepTheMomentumOfZonesWithoutObstacles) {
  Crossing c(false);
  c.stage.parameters.impact_zones.solver = GetParam();
  c.find();
  const std::vector<Index> zone = union_find(c.stage, c.ccd.impacts().download());
  c.solve();
  const std::vector<Vec3r> x1 = c.stage.state.x1.download(),
                           target = c.stage.state.candidate.download();
  std::map<Index, std::pair<Vec3d, double>> moved;  // Σ m Δx and Σ m |Δx|
  for (std::size_t i = 0; i < zone.size(); ++i) {
    if (zone[i] < 0) continue;
    const Vec3d d = convert<double>(x1[i]) - convert<double>(target[i]);
    moved[zone[i]].first += c.stage.world.mass[i] * d;
    moved[zone[i]].second += c.stage.world.mass[i] * norm(d);
  }
  ASSERT_GE(moved.size(), 3u);
  for (const auto& [label, sum] : moved) EXPECT_LT(norm(sum.first), 0.02 * sum.second) << label;
}

TEST_P(ImpactZoneSolvers, EndTheRoundsWithoutImpacts) {
  Crossing c(true);
  c.stage.parameters.impact_zones.solver = GetParam();
  c.find();
  int round = 0;
  for (; round < c.stage.parameters.impact_zones.max_rounds && !c.ccd.impacts().empty(); ++round) {
    c.solve();
    c.find(true);
  }
  EXPECT_GT(round, 0);
  EXPECT_TRUE(c.ccd.impacts().empty());
  c.find();  // all pairs, not only those with a dirty vertex
  EXPECT_TRUE(c.ccd.impacts().empty());
}

/// Two large sheets are one zone, which all threads solve together.
TEST_P(ImpactZoneSolvers, GiveLargeZonesToAllThreads) {
  const auto solve = [](int threads) {
    set_thread_count(threads);
    CrossingSheets sheets(GetParam());
    sheets.solve();
    set_thread_count(0);
    EXPECT_GT(sheets.stage.report.largest_zone, kLargestTeamZone);
    return sheets.stage.state.x1.download();
  };
  EXPECT_TRUE(solve(1) == solve(4));
}

std::vector<Vec3r> result_with_threads(ZoneSolver solver, int threads) {
  set_thread_count(threads);
  Crossing c(true);
  c.stage.parameters.impact_zones.solver = solver;
  c.find();
  for (int round = 0; round < 3; ++round) {
    c.solve();
    c.find(true);
  }
  set_thread_count(0);
  return c.stage.state.x1.download();
}

/// Incremental detection finds in every round what a full one finds (Algorithm 1).
TEST_P(ImpactZoneSolvers, LeaveNothingToAFullDetection) {
  for (const BroadPhaseMethod method : {BroadPhaseMethod::tree, BroadPhaseMethod::hash}) {
    Crossing c(true, Real(0.006));
    c.stage.parameters.impact_zones.solver = GetParam();
    c.stage.parameters.broad_phase.method = method;
    c.stage.parameters.impact_zones.iterations = 2;  // leaves work for more rounds
    c.find();
    int round = 0;
    for (; round < 10 && !c.ccd.impacts().empty(); ++round) {
      c.solve();
      SubstepContext step = c.stage.context();
      c.broad_phase.cover_dirty(step, c.zones.dirty());
      c.ccd.find(step, c.broad_phase, c.zones.dirty(), true);

      // A full detection makes boxes of its own; those of the state belong to the lists above.
      Memory before;
      before.copy_from(c.stage.state);
      BroadPhase fresh;
      Ccd full;
      fresh.cover_candidate(step);
      full.find(step, fresh, {}, false);
      static_cast<Memory&>(c.stage.state).copy_from(before);
      std::vector<std::uint64_t> incremental_keys, full_keys;
      for (const Impact& impact : c.ccd.impacts().download())
        incremental_keys.push_back(impact.key);
      for (const Impact& impact : full.impacts().download()) full_keys.push_back(impact.key);
      EXPECT_EQ(incremental_keys, full_keys) << "round " << round;
    }
    EXPECT_GE(round, 1);
  }
}

TEST_P(ImpactZoneSolvers, GiveTheSameBitsWithAnyNumberOfThreads) {
  const std::vector<Vec3r> one = result_with_threads(GetParam(), 1);
  EXPECT_TRUE(one == result_with_threads(GetParam(), 2));
  EXPECT_TRUE(one == result_with_threads(GetParam(), 4));
}

TEST(ImpactZones, PlainGradientStepsReachTheConstraintsToo) {
  Crossing c(true, Real(0.003));
  c.stage.parameters.impact_zones.solver = ZoneSolver::augmented_lagrangian;
  c.stage.parameters.impact_zones.chebyshev = false;
  c.stage.parameters.impact_zones.iterations = 2000;
  c.find();
  const std::vector<Impact> impacts = c.ccd.impacts().download();
  c.solve();
  const std::vector<Vec3r> x1 = c.stage.state.x1.download();
  for (const Impact& impact : impacts)
    EXPECT_GE(gap(impact, x1), 0.79 * c.stage.parameters.impact_zones.offset);
}

}  // namespace
}  // namespace icloth::cpu32
