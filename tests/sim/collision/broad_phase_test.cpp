// The candidate lists against all pairs, whose paths are compared one by one.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include "sim/collision/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/parallel/parallel.h"
#include "tests/support/stage_support.h"

namespace icloth::cpu32 {
namespace {

Scene two_sheets_and_a_ball() {
  Scene scene;
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.3, 160), {0, 0.02, 0}));
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.2, 90), {0.02, 0.04, 0.01}));
  scene.obstacles.push_back(testing::make_obstacle(make_sphere(0.08, 80), {0, -0.06, 0}));
  scene.obstacles.push_back(testing::make_obstacle(make_sphere(0.03, 20), {0, 0, 0}));
  scene.parameters.proximity.thickness = 4e-3;
  return scene;
}

std::vector<std::uint64_t> keys(const BroadPhase& broad_phase) {
  std::vector<std::uint64_t> out;
  for (const Pair& p : broad_phase.vertex_faces().download()) out.push_back(pair_key(false, p));
  for (const Pair& p : broad_phase.edge_edges().download()) out.push_back(pair_key(true, p));
  std::sort(out.begin(), out.end());
  return out;
}

/// Keys of all pairs whose elements, on straight ways from x0 to `end`, come within `distance` in
/// every axis at one of many moments.
std::vector<std::uint64_t> near_pairs(const Stage& stage, const std::vector<Vec3r>& end,
                                      double distance) {
  const auto box = [&](const Index* first, const Index* last, double time) {
    std::array<double, 6> b{1e9, 1e9, 1e9, -1e9, -1e9, -1e9};
    for (const Index* i = first; i != last; ++i) {
      const Vec3r &p = stage.start[static_cast<std::size_t>(*i)],
                  &q = end[static_cast<std::size_t>(*i)];
      const double from[3] = {p.x, p.y, p.z}, to[3] = {q.x, q.y, q.z};
      for (std::size_t k = 0; k < 3; ++k) {
        const double c = (1 - time) * from[k] + time * to[k];
        b[k] = std::min(b[k], c);
        b[3 + k] = std::max(b[3 + k], c);
      }
    }
    return b;
  };
  std::vector<std::uint64_t> out;
  for_all_pairs(stage.world, [&](bool edge_edge, Pair pair, const std::vector<Index>& v) {
    const Index* split = v.data() + (edge_edge ? 2 : 1);
    constexpr int kMoments = 8;
    for (int moment = 0; moment <= kMoments; ++moment) {
      const double time = static_cast<double>(moment) / kMoments;
      const auto a = box(v.data(), split, time), b = box(split, v.data() + 4, time);
      bool near = true;
      for (std::size_t k = 0; k < 3; ++k)
        near = near && a[k] <= b[3 + k] + distance && b[k] <= a[3 + k] + distance;
      if (!near) continue;
      out.push_back(pair_key(edge_edge, pair));
      break;
    }
  });
  std::sort(out.begin(), out.end());
  return out;
}

void expect_complete(const BroadPhase& broad_phase, const Stage& stage,
                     const std::vector<Vec3r>& end, double distance) {
  const std::vector<std::uint64_t> found = keys(broad_phase),
                                   needed = near_pairs(stage, end, distance);
  EXPECT_GT(needed.size(), 300u);
  EXPECT_TRUE(std::includes(found.begin(), found.end(), needed.begin(), needed.end()));
}

void expect_valid(const BroadPhase& broad_phase, const Stage& stage) {
  const std::vector<std::uint64_t> found = keys(broad_phase);
  EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "a pair twice";
  EXPECT_EQ(broad_phase.candidate_count(), static_cast<std::int64_t>(found.size()));
  std::vector<std::uint64_t> allowed;  // no shared vertex, no two obstacles, smaller edge first
  for_all_pairs(stage.world, [&](bool edge_edge, Pair pair, const std::vector<Index>&) {
    allowed.push_back(pair_key(edge_edge, pair));
  });
  std::sort(allowed.begin(), allowed.end());
  EXPECT_TRUE(std::includes(allowed.begin(), allowed.end(), found.begin(), found.end()));
  EXPECT_LT(found.size(), allowed.size() / 2) << "hardly anything left out";
}

/// Calls of a primitive since `profile_reset`.
std::int64_t calls_of(const char* name) {
  for (const ProfileRow& row : profile_rows())
    if (row.name == name) return row.calls;
  return 0;
}
/// Candidate lists made since then.
std::int64_t lists_made() { return calls_of("broad_phase.vertex_boxes"); }

/// Both finders have to give complete and valid lists.
class BroadPhaseMethods : public ::testing::TestWithParam<BroadPhaseMethod> {};
INSTANTIATE_TEST_SUITE_P(All, BroadPhaseMethods,
                         ::testing::Values(BroadPhaseMethod::tree, BroadPhaseMethod::hash));

TEST_P(BroadPhaseMethods, CoverPredictedPathsAndTheThickness) {
  std::mt19937 random(1);
  Stage stage(two_sheets_and_a_ball());
  stage.parameters.broad_phase.method = GetParam();
  BroadPhase broad_phase;
  for (int trial = 0; trial < 20; ++trial) {  // trees are refitted and rebuilt on the way
    stage.start = sum(stage.start, random_vectors(stage, random, 0.004f, false));
    stage.state.x0.upload(stage.start);
    const auto velocity = random_vectors(stage, random, 0.1f * static_cast<Real>(trial), true);
    stage.set_velocity(velocity);
    SubstepContext step = stage.context();
    broad_phase.prepare(step);
    std::vector<Vec3r> end = sum(stage.start, velocity, step.dt);
    for (Index i = 0; i < stage.world.cloth_vertices; ++i)
      end[static_cast<std::size_t>(i)] += step.dt * step.dt * step.gravity();
    expect_complete(broad_phase, stage, end, stage.parameters.proximity.thickness);
    expect_valid(broad_phase, stage);
  }
}

TEST_P(BroadPhaseMethods, CoverTheCandidateWhereverItGoes) {
  std::mt19937 random(2);
  Stage stage(two_sheets_and_a_ball());
  stage.parameters.broad_phase.method = GetParam();
  BroadPhase broad_phase;
  SubstepContext step = stage.context();
  broad_phase.prepare(step);
  for (const Real size : {0.001f, 0.01f, 0.05f, 0.002f}) {
    const auto end = sum(stage.start, random_vectors(stage, random, size, true));
    stage.set_end(end);
    broad_phase.cover_candidate(step);
    expect_complete(broad_phase, stage, end, 0);
    expect_valid(broad_phase, stage);
  }
}

TEST(BroadPhase, ListsThatCannotLastAreShorterAndComplete) {
  std::mt19937 random(5);
  Stage stage(two_sheets_and_a_ball());
  const auto velocity = random_vectors(stage, random, 1.0f, true);
  stage.set_velocity(velocity);
  SubstepContext step = stage.context();
  std::vector<Vec3r> end = sum(stage.start, velocity, step.dt);
  for (Index i = 0; i < stage.world.cloth_vertices; ++i)
    end[static_cast<std::size_t>(i)] += step.dt * step.dt * step.gravity();

  // The slack that lets lists serve several steps is left out where nothing could stay in it.
  std::int64_t lasting = 0;
  for (const double fastest : {0.0, 1.0}) {
    step.fastest = fastest;
    stage.state.trusted_complete = false;
    BroadPhase broad_phase;
    broad_phase.prepare(step);
    expect_complete(broad_phase, stage, end, stage.parameters.proximity.thickness);
    expect_valid(broad_phase, stage);
    if (fastest == 0)
      lasting = broad_phase.candidate_count();
    else
      EXPECT_LT(broad_phase.candidate_count(), lasting);
  }
}

/// Keys of the pairs with a dirty vertex.
std::vector<std::uint64_t> dirty_keys(const Stage& stage, const std::vector<std::uint64_t>& keys,
                                      const std::vector<std::uint8_t>& dirty) {
  std::vector<std::uint64_t> out;
  for (const std::uint64_t key : keys) {
    const Pair p = key_pair(key);
    for (const Index v : corners(stage.world, key_is_edge_edge(key), p.a, p.b)) {
      if (v >= stage.world.cloth_vertices || dirty[static_cast<std::size_t>(v)] == 0) continue;
      out.push_back(key);
      break;
    }
  }
  return out;
}

TEST_P(BroadPhaseMethods, FindThePairsOfDirtyVertices) {
  std::mt19937 random(4);
  Stage stage(two_sheets_and_a_ball());
  stage.parameters.broad_phase.method = GetParam();
  SubstepContext step = stage.context();
  BroadPhase broad_phase;
  broad_phase.prepare(step);
  std::vector<std::uint8_t> dirty(static_cast<std::size_t>(stage.world.cloth_vertices));
  Array<std::uint8_t> flags;
  for (const unsigned share : {2u, 10u, 100u, 1u}) {
    std::vector<Vec3r> end = stage.start;
    const auto moved = random_vectors(stage, random, 0.03f, false);
    for (std::size_t i = 0; i < dirty.size(); ++i) {
      dirty[i] = random() % share == 0 ? 1 : 0;
      if (dirty[i] != 0) end[i] += moved[i];
    }
    stage.set_end(end);
    flags.upload(dirty);
    broad_phase.cover_dirty(step, flags.view());
    const auto found = keys(broad_phase);
    const auto needed = dirty_keys(stage, near_pairs(stage, end, 0), dirty);
    EXPECT_GT(needed.size(), 10u);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), needed.begin(), needed.end())) << share;
    EXPECT_EQ(dirty_keys(stage, found, dirty), found) << "pairs without a dirty vertex";
    expect_valid(broad_phase, stage);
  }
  // The lists of dirty pairs are no longer complete: the next step makes them anew.
  broad_phase.prepare(step);
  expect_complete(broad_phase, stage, stage.start, stage.parameters.proximity.thickness);
}

TEST(BroadPhase, KeepsTheListsWhileTheMotionStaysInTheBoxes) {
  std::mt19937 random(3);
  Stage stage(two_sheets_and_a_ball());
  stage.set_velocity(random_vectors(stage, random, 1.0f, false));
  SubstepContext step = stage.context();
  BroadPhase broad_phase;
  profile_reset();
  profile_enable(true);
  broad_phase.prepare(step);
  EXPECT_EQ(lists_made(), 1);
  stage.set_end(sum(stage.start, stage.state.v.download(), 0.009f));
  broad_phase.cover_candidate(step);
  broad_phase.prepare(step);
  EXPECT_EQ(lists_made(), 1);
  // One vertex alone leaves its box.
  std::vector<Vec3r> end = stage.start;
  end[7].y += 0.2f;
  stage.set_end(end);
  broad_phase.cover_candidate(step);
  EXPECT_EQ(lists_made(), 2);
  broad_phase.invalidate(stage.state);
  broad_phase.cover_candidate(step);
  EXPECT_EQ(lists_made(), 3);
  profile_enable(false);
}

TEST_P(BroadPhaseMethods, ReplaceTheFewVerticesThatLeaveTheirBoxes) {
  std::mt19937 random(5);
  Stage stage(two_sheets_and_a_ball());
  stage.parameters.broad_phase.method = GetParam();
  SubstepContext step = stage.context();
  BroadPhase broad_phase;
  broad_phase.prepare(step);
  for (int trial = 0; trial < 10; ++trial) {
    // Some steps go on from where the one before ended: the others then stay in their second boxes.
    if (trial % 3 == 2) {
      stage.start = stage.state.x1.download();
      stage.state.x0.upload(stage.start);
    }
    std::vector<Vec3r> end = stage.start;
    for (int k = 0; k < 6; ++k) {
      const auto moved = random_vectors(stage, random, 0.02f, false);
      const auto v = random() % static_cast<unsigned>(stage.world.cloth_vertices);
      end[v] += moved[v];
    }
    stage.set_end(end);
    profile_reset();
    profile_enable(true);
    broad_phase.cover_candidate(step);
    EXPECT_GT(calls_of("broad_phase.keep"), 0) << "the pairs of the others are kept";
    expect_complete(broad_phase, stage, end, 0);
    expect_valid(broad_phase, stage);

    // The same boxes give the same pairs to a search that starts from them.
    std::vector<Vec3r> velocity = stage.start;
    for (std::size_t v = 0; v < velocity.size(); ++v) {
      velocity[v] = (1 / step.dt) * (end[v] - stage.start[v]);
      if (v < at(stage.world.cloth_vertices)) velocity[v] -= step.dt * step.gravity();
    }
    stage.set_velocity(velocity);
    BroadPhase other;
    profile_reset();
    const double thickness = std::exchange(stage.parameters.proximity.thickness, 0);
    other.prepare(step);
    stage.parameters.proximity.thickness = thickness;
    EXPECT_EQ(lists_made(), 0) << "the boxes hold";
    profile_enable(false);
    EXPECT_EQ(keys(other), keys(broad_phase)) << trial;
  }
}

/// Sheets that fall side by side stay apart, however far they fall in a step.
TEST_P(BroadPhaseMethods, LeaveOutLayersThatMoveTogether) {
  Scene scene;
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.3, 160), {0, 0, 0}));
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.3, 160), {0, 0.03, 0}));
  scene.parameters.proximity.thickness = 4e-3;
  Stage stage(std::move(scene));
  stage.parameters.broad_phase.method = GetParam();
  std::vector<Vec3r> velocity(at(stage.world.vertices), Vec3r{0, -10, 0});
  stage.set_velocity(velocity);
  SubstepContext step = stage.context();
  BroadPhase broad_phase;
  broad_phase.prepare(step);
  const Index half = stage.world.cloth_vertices / 2, faces = stage.world.cloth_faces / 2;
  for (const Pair& p : broad_phase.vertex_faces().download())
    EXPECT_EQ(p.a < half, p.b < faces) << "a pair of both sheets";
}

TEST(BroadPhase, ClothAloneAndASingleFaceHaveNoMissingTree) {
  Scene scene;
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.1, 2), {}));
  Stage stage(std::move(scene));
  SubstepContext step = stage.context();
  BroadPhase broad_phase;
  broad_phase.prepare(step);
  std::size_t needed = 0;
  for_all_pairs(stage.world, [&](bool, Pair, const std::vector<Index>&) { ++needed; });
  EXPECT_LE(keys(broad_phase).size(), needed);
}

}  // namespace
}  // namespace icloth::cpu32
