// The impacts of a tangled motion against the elementary test over all pairs.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/ccd/elementary_ccd.h"
#include "sim/collision/ccd.h"
#include "tests/support/stage_support.h"

namespace icloth::cpu32 {
namespace {

Scene sheets_and_ball() {
  Scene scene;
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.3, 140), {0, 0.03, 0}));
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.2, 90), {0.02, 0.06, 0.01}));
  scene.cloths[0].pins = {0, 1, 2, 3, 4};
  scene.obstacles.push_back(testing::make_obstacle(make_sphere(0.1, 80), {0, -0.08, 0}));
  return scene;
}

std::vector<std::uint64_t> keys(const Ccd& ccd) {
  std::vector<std::uint64_t> out;
  for (const Impact& impact : ccd.impacts().download()) out.push_back(impact.key);
  EXPECT_TRUE(std::is_sorted(out.begin(), out.end()));
  return out;
}

/// Keys of all pairs that meet and can be moved apart.
std::vector<std::uint64_t> brute_force(const Stage& stage, const std::vector<Vec3r>& end) {
  std::vector<std::uint64_t> out;
  const std::vector<Real> inverse_mass = stage.state.inverse_mass.download();
  for_all_pairs(stage.world, [&](bool edge_edge, Pair pair, const std::vector<Index>& v) {
    CcdQuery<Real> q;
    bool movable = false;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto i = static_cast<std::size_t>(v[a]);
      q.p0[a] = stage.start[i];
      q.p1[a] = end[i];
      movable = movable || inverse_mass[i] > 0;
    }
    CcdHit hit;
    const double separation =
        0.25 * static_cast<double>(static_cast<Real>(stage.parameters.impact_zones.offset));
    if (movable && (edge_edge ? ccd_ee(q, separation, hit) : ccd_vf(q, separation, hit)))
      out.push_back(pair_key(edge_edge, pair));
  });
  std::sort(out.begin(), out.end());
  return out;
}

/// A start without touching pairs, and an end where everything is mixed up.
struct Tangle {
  std::mt19937 random;
  Stage stage{sheets_and_ball()};
  std::vector<Vec3r> end;
  BroadPhase broad_phase;
  Ccd ccd;

  explicit Tangle(unsigned seed, Real size) : random(seed) {
    stage.start = sum(stage.start, random_vectors(stage, random, 0.004f, false));
    stage.state.x0.upload(stage.start);
    end = sum(stage.start, random_vectors(stage, random, size, true));
    for (Index i = 0; i < 5; ++i)
      end[static_cast<std::size_t>(i)] = stage.start[static_cast<std::size_t>(i)];
    stage.set_end(end);
  }
  void find(const std::vector<std::uint8_t>* dirty = nullptr) {
    SubstepContext step = stage.context();
    broad_phase.cover_candidate(step);
    Array<std::uint8_t> flags;
    if (dirty) flags.upload(*dirty);
    ccd.find(step, broad_phase, flags.view(), dirty != nullptr);
  }
};

TEST(CcdStage, FindsExactlyTheImpactsOfAllPairs) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Tangle t(seed, 0.02f * static_cast<Real>(seed + 1));
    t.find();
    const std::vector<std::uint64_t> expected = brute_force(t.stage, t.end);
    EXPECT_GT(expected.size(), 50u);
    EXPECT_EQ(keys(t.ccd), expected);
    EXPECT_EQ(t.stage.report.elementary_tests, t.broad_phase.candidate_count());
  }
}

TEST(CcdStage, ImpactsDescribeTheirPair) {
  Tangle t(5, 0.04f);
  t.find();
  for (const Impact& impact : t.ccd.impacts().download()) {
    const Pair pair = key_pair(impact.key);
    const bool edge_edge = key_is_edge_edge(impact.key);
    const std::vector<Index> v = corners(t.stage.world, edge_edge, pair.a, pair.b);
    Vec3d gap;
    double weights = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      EXPECT_EQ(impact.s.v[a], v[a]);
      weights += static_cast<double>(impact.s.w[a]);
      const auto i = static_cast<std::size_t>(v[a]);
      const Vec3d p0 = convert<double>(t.stage.start[i]), p1 = convert<double>(t.end[i]);
      gap +=
          static_cast<double>(impact.s.w[a]) * (p0 + static_cast<double>(impact.toi) * (p1 - p0));
    }
    EXPECT_NEAR(weights, 0, 1e-5);
    EXPECT_LT(norm(gap), 1e-5) << "not together at the time of impact";
    EXPECT_NEAR(norm(convert<double>(impact.normal)), 1, 1e-5);
    EXPECT_GE(impact.toi, 0);
    EXPECT_LE(impact.toi, 1);
  }
}

TEST(CcdStage, DirtyPairsAloneGiveTheSameAsAll) {
  Tangle t(6, 0.03f);
  t.find();
  for (int round = 0; round < 10; ++round) {
    std::vector<std::uint8_t> dirty(static_cast<std::size_t>(t.stage.world.cloth_vertices), 0);
    for (const Impact& impact : t.ccd.impacts().download())
      for (const Index v : impact.s.v)
        if (v < t.stage.world.cloth_vertices) dirty[static_cast<std::size_t>(v)] = 1;
    // Some vertices move on their own, most of the rest stays.
    for (std::size_t i = 5; i < dirty.size(); ++i) {
      if (t.random() % 10 != 0) continue;
      dirty[i] = 1;
      t.end[i] = t.stage.start[i] + Real(0.5) * (t.end[i] - t.stage.start[i]);
    }
    t.stage.set_end(t.end);
    t.find(&dirty);
    EXPECT_EQ(keys(t.ccd), brute_force(t.stage, t.end)) << round;
  }
}

TEST(CcdStage, CleanPairsAreLeftOut) {
  Tangle t(7, 0.03f);
  const std::vector<std::uint8_t> clean(static_cast<std::size_t>(t.stage.world.cloth_vertices), 0);
  t.find(&clean);
  EXPECT_TRUE(t.ccd.impacts().empty());
}

}  // namespace
}  // namespace icloth::cpu32
