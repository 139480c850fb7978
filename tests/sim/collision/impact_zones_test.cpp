// Impact zones of crossing sheets: constraints, zones, momentum, threads.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include "sim/collision/impact_zones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "sim/simulator.h"
#include "tests/support/stage_support.h"

namespace icloth::cpu32 {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Three pairs of sheets that pass through each other, and a sheet that falls into a ball.
struct Crossing {
  Stage stage;
  BroadPhase broad_phase;
  Ccd ccd;
  ImpactZones zones;

  static Scene scene(bool ball) {
    Scene scene;
    for (int pair = 0; pair < 3; ++pair) {
      const Vec3d place{0.5 * pair, 0, 0};
      scene.cloths.push_back(
          testing::make_sheet(testing::lying(0.1 + 0.05 * pair, 60 + 60 * pair), place));
      scene.cloths.push_back(
          testing::make_sheet(testing::lying(0.12, 70), place + Vec3d{0.01, 0.004, 0.013}));
    }
    if (!ball) return scene;
    scene.cloths.push_back(testing::make_sheet(testing::lying(0.2, 100), {0, 0.105, 1}));
    scene.obstacles.push_back(testing::make_obstacle(make_sphere(0.1, 180), {0, 0, 1}));
    return scene;
  }

  explicit Crossing(bool ball, Real speed = Real(0.004)) : stage(scene(ball)) {
    std::mt19937 random(1);
    stage.start = sum(stage.start, random_vectors(stage, random, Real(1e-3), false));
    stage.state.x0.upload(stage.start);
    std::vector<Vec3r> end = sum(stage.start, random_vectors(stage, random, Real(1e-3), false));
    for (Index i = 0; i < stage.world.cloth_vertices; ++i) {
      const bool upper = stage.world.object[at(i)] % 2 == 1;
      end[at(i)].y += stage.world.object[at(i)] == 6 ? -2 * speed : (upper ? -speed : speed);
    }
    stage.set_end(end);
    zones.begin_substep();
  }

  void find(bool incremental = false) {
    SubstepContext step = stage.context();
    broad_phase.cover_candidate(step);
    ccd.find(step, broad_phase, zones.dirty(), incremental);
  }
  void solve() {
    SubstepContext step = stage.context();
    zones.solve(step, ccd.impacts());
  }
};

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

double gap(const Impact& impact, const std::vector<Vec3r>& x) {
  Vec3d sum;
  for (int a = 0; a < 4; ++a)
    sum += static_cast<double>(impact.s.w[a]) * convert<double>(x[at(impact.s.v[a])]);
  return dot(convert<double>(impact.normal), sum);
}

class ImpactZoneSolvers : public ::testing::TestWithParam<ZoneSolver> {};
INSTANTIATE_TEST_SUITE_P(All, ImpactZoneSolvers,
                         ::testing::Values(ZoneSolver::augmented_lagrangian, ZoneSolver::dual,
                                           ZoneSolver::linear));

TEST_P(ImpactZoneSolvers, OpenEveryConstraint) {
  Crossing c(true);
  c.stage.parameters.impact_zones.solver = GetParam();
  c.find();
  const std::vector<Impact> impacts = c.ccd.impacts().download();
  ASSERT_GT(impacts.size(), 200u);
  c.solve();
  const std::vector<Vec3r> x1 = c.stage.state.x1.download();
  for (const Impact& impact : impacts)
    EXPECT_GE(gap(impact, x1), 0.79 * c.stage.parameters.impact_zones.offset);
}

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

/// Two large sheets that pass through each other everywhere: one zone, solved by all threads.
std::vector<Vec3r> solve_large_zone(ZoneSolver solver, int threads, Index& largest,
                                    double& smallest_gap) {
  set_thread_count(threads);
  Scene scene;
  for (int sheet = 0; sheet < 2; ++sheet)
    scene.cloths.push_back(testing::make_sheet(testing::lying(0.5, 2400), {0, 0.004 * sheet, 0}));
  Stage stage(scene);
  stage.parameters.impact_zones.solver = solver;
  std::vector<Vec3r> end = stage.start;
  for (Index i = 0; i < stage.world.cloth_vertices; ++i)
    end[at(i)].y += stage.world.object[at(i)] == 1 ? Real(-0.004) : Real(0.004);
  stage.set_end(end);
  BroadPhase broad_phase;
  Ccd ccd;
  ImpactZones zones;
  zones.begin_substep();
  SubstepContext step = stage.context();
  broad_phase.cover_candidate(step);
  ccd.find(step, broad_phase, zones.dirty(), false);
  zones.solve(step, ccd.impacts());
  set_thread_count(0);
  largest = static_cast<Index>(stage.report.largest_zone);
  const std::vector<Vec3r> x1 = stage.state.x1.download();
  smallest_gap = 1;
  for (const Impact& impact : ccd.impacts().download())
    smallest_gap = std::min(smallest_gap, gap(impact, x1) / stage.parameters.impact_zones.offset);
  return x1;
}

TEST_P(ImpactZoneSolvers, GiveLargeZonesToAllThreads) {
  Index largest = 0;
  double smallest_gap = 0;
  const std::vector<Vec3r> one = solve_large_zone(GetParam(), 1, largest, smallest_gap);
  EXPECT_GT(largest, kLargestTeamZone);
  EXPECT_GE(smallest_gap, 0.79);
  EXPECT_TRUE(one == solve_large_zone(GetParam(), 4, largest, smallest_gap));
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
      BroadPhase fresh;
      Ccd full;
      fresh.cover_candidate(step);
      full.find(step, fresh, {}, false);
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
