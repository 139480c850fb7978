// Whole steps through the public interface.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "kernels/index.h"
#include "sim/simulator.h"
#include "tests/support/intersections.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::count_intersections;
using testing::hanging;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;

std::shared_ptr<Scene> new_scene() {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->parameters.wind.air_density = 0;
  return scene;
}

/// A sheet just over a ball.
std::shared_ptr<Scene> ball_scene(Index triangles = 300) {
  auto scene = new_scene();
  scene->cloths.push_back(make_sheet(lying(0.4, triangles), {0.01, 0.112, 0.02}));
  scene->obstacles.push_back(make_obstacle(make_sphere(0.1, 320), {}));
  return scene;
}

/// Steps that must be accepted, without a crossing pair of faces after any of them.
void run_cleanly(Simulator& simulator, int steps) {
  for (int k = 0; k < steps; ++k) {
    const StepReport report = simulator.step({});
    ASSERT_TRUE(report.accepted) << "step " << k;
    ASSERT_EQ(report.impacts_left, 0) << "step " << k;
    ASSERT_EQ(count_intersections(simulator), 0u) << "step " << k;
  }
}

Vec3d mean_position(const Simulator& simulator, std::size_t vertices) {
  const Snapshot s = simulator.snapshot();
  Vec3d sum;
  for (std::size_t i = 0; i < vertices; ++i) sum += s.x1[i];
  return (1 / static_cast<double>(vertices)) * sum;
}

bool same_state(const Snapshot& a, const Snapshot& b) {
  return a.step == b.step && a.time == b.time && a.x1 == b.x1 && a.v == b.v;
}

class Builds : public ::testing::TestWithParam<Build> {
 protected:
  void SetUp() override {
    std::string reason;
    if (!build_available(GetParam(), &reason)) GTEST_SKIP() << reason;
  }
  std::unique_ptr<Simulator> make(std::shared_ptr<const Scene> scene) const {
    return make_simulator(GetParam(), std::move(scene));
  }
};

INSTANTIATE_TEST_SUITE_P(Step, Builds, ::testing::Values(Build::cpu32, Build::cpu64, Build::cuda32),
                         [](const auto& instance) {
                           return std::string(build_name(instance.param));
                         });

TEST_P(Builds, FreeFallIsBackwardEuler) {
  auto scene = new_scene();
  scene->cloths.push_back(make_sheet(lying(0.3, 200), {}));
  scene->parameters.implicit.cg_tolerance = 1e-6;  // it bounds the error of every step
  const auto simulator = make(scene);
  const std::vector<Vec3d> start = simulator->snapshot().x1;
  const double dt = scene->parameters.step.time_step, g = scene->parameters.gravity.y;
  for (int n = 1; n <= 40; ++n) {
    ASSERT_TRUE(simulator->step({}).accepted);
    const double t = n * dt, fall = 0.5 * g * t * (t + dt);
    const std::vector<Vec3d> x = simulator->snapshot().x1;
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(x[i].y - start[i].y, fall, 1e-5 * std::fabs(fall) + 1e-7);
      EXPECT_NEAR(x[i].x, start[i].x, 1e-5 * std::fabs(fall) + 1e-7);
    }
  }
  EXPECT_NEAR(simulator->time(), 40 * dt, 1e-12);
}

TEST_P(Builds, PinnedVerticesDoNotMoveByABit) {
  auto scene = new_scene();
  GridMesh grid = make_grid(hanging(0.3, 200));
  scene->cloths.push_back(make_sheet(hanging(0.3, 200), {0.123, 0.456, 0.789}));
  scene->cloths[0].pins = grid_vertices(grid, "top");
  scene->parameters.wind.z = 4;
  scene->parameters.wind.air_density = 1;
  const auto simulator = make(scene);
  const Snapshot start = simulator->snapshot();
  for (int k = 0; k < 30; ++k) ASSERT_TRUE(simulator->step({}).accepted);
  const Snapshot end = simulator->snapshot();
  for (const Index pin : scene->cloths[0].pins) {
    EXPECT_TRUE(end.x1[at(pin)] == start.x1[at(pin)]);
    EXPECT_TRUE(end.v[at(pin)] == Vec3d{});
  }
  EXPECT_GT(norm(end.x1[0] - start.x1[0]), 1e-3);
}

TEST_P(Builds, WindLiftsAFlag) {
  auto scene = new_scene();
  GridMesh grid = make_grid(hanging(0.3, 200));
  scene->cloths.push_back(make_sheet(hanging(0.3, 200), {}));
  scene->cloths[0].pins = grid_vertices(grid, "top");
  scene->parameters.wind.z = 5;
  const auto still = make(scene);  // without air the wind does nothing
  auto windy = std::make_shared<Scene>(*scene);
  windy->parameters.wind.air_density = 1;
  const auto blown = make(windy);
  for (int k = 0; k < 40; ++k) {
    ASSERT_TRUE(still->step({}).accepted);
    ASSERT_TRUE(blown->step({}).accepted);
  }
  EXPECT_LT(std::fabs(mean_position(*still, grid.mesh.positions.size()).z), 0.005);
  EXPECT_GT(mean_position(*blown, grid.mesh.positions.size()).z, 0.03);
}

TEST_P(Builds, SheetOnABallNeverIntersects) {
  const auto simulator = make(ball_scene());
  run_cleanly(*simulator, 60);
  EXPECT_GT(mean_position(*simulator, simulator->scene().cloths[0].mesh.positions.size()).y, -0.1);
}

TEST_P(Builds, TwoSheetsOnABoxNeverIntersect) {
  auto scene = new_scene();
  scene->cloths.push_back(make_sheet(lying(0.3, 200), {0.003, 0.06, 0.002}));
  scene->cloths.push_back(make_sheet(lying(0.25, 150), {-0.02, 0.09, 0.01}));
  scene->obstacles.push_back(make_obstacle(make_box({0.15, 0.1, 0.15}, 0.05), {}));
  run_cleanly(*make(scene), 60);
}

TEST_P(Builds, ImpactZonesAloneHoldTheClothToo) {
  auto scene = ball_scene(150);
  scene->parameters.proximity.enabled = false;
  const auto simulator = make(scene);
  run_cleanly(*simulator, 40);
}

/// Steps in which impacts are resolved, and the states after each.
std::vector<std::uint64_t> hashes(Simulator& simulator, int steps, std::int64_t& rounds) {
  std::vector<std::uint64_t> out;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = simulator.step({});
    rounds += report.rounds;
    out.push_back(report.state_hash);
  }
  return out;
}

TEST_P(Builds, IncrementalDetectionAndTheBroadPhaseDoNotChangeABit) {
  std::vector<std::uint64_t> expected;
  for (const bool incremental : {true, false}) {
    for (const BroadPhaseMethod method : {BroadPhaseMethod::tree, BroadPhaseMethod::hash}) {
      auto scene = new_scene();
      for (int k = 0; k < 3; ++k)
        scene->cloths.push_back(make_sheet(lying(0.3, 300), {0.01 * k, 0.13 + 0.01 * k, 0}));
      scene->obstacles.push_back(make_obstacle(make_sphere(0.1, 320), {}));
      scene->parameters.proximity.enabled = false;  // everything is left to the impact zones
      scene->parameters.ccd.incremental = incremental;
      scene->parameters.broad_phase.method = method;
      const auto simulator = make(scene);
      std::int64_t rounds = 0;
      const auto states = hashes(*simulator, 30, rounds);
      EXPECT_GT(rounds, 20);
      if (expected.empty()) expected = states;
      EXPECT_EQ(states, expected);
    }
  }
}

TEST_P(Builds, SnapshotAndRestoreGiveTheSameStateAndFuture) {
  const auto simulator = make(ball_scene(150));
  for (int k = 0; k < 20; ++k) simulator->step({});
  const Snapshot middle = simulator->snapshot();
  const std::uint64_t hash = simulator->state_hash();
  for (int k = 0; k < 10; ++k) simulator->step({});
  EXPECT_NE(simulator->state_hash(), hash);
  simulator->restore(middle);
  EXPECT_TRUE(same_state(simulator->snapshot(), middle));
  EXPECT_EQ(simulator->state_hash(), hash);
  EXPECT_EQ(simulator->step_index(), 20);
  const auto other = make(simulator->scene().cloths.empty() ? nullptr : ball_scene(150));
  other->restore(middle);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(simulator->step({}).state_hash, other->step({}).state_hash);
  Snapshot wrong = middle;
  wrong.x1.pop_back();
  EXPECT_THROW(simulator->restore(wrong), std::invalid_argument);
}

TEST_P(Builds, TheTwoStepIntegratorHoldsTheClothAndGoesOnFromASnapshot) {
  auto scene = std::make_shared<Scene>(*ball_scene(150));
  scene->parameters.implicit.integrator = Integrator::bdf2;
  const auto simulator = make(scene);
  run_cleanly(*simulator, 20);
  const Snapshot middle = simulator->snapshot();
  EXPECT_GT(middle.past.dt, 0);
  const auto other = make(scene);
  other->restore(middle);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(simulator->step({}).state_hash, other->step({}).state_hash);
  Snapshot wrong = middle;
  wrong.past.change.pop_back();
  EXPECT_THROW(other->restore(wrong), std::invalid_argument);
  // Without its past it goes on as well, by a step of the first order.
  Snapshot afresh = middle;
  afresh.past.forget();
  other->restore(afresh);
  run_cleanly(*other, 5);
}

/// Denim, with the internal friction of its yarns.
std::shared_ptr<Scene> denim_scene(Index triangles) {
  auto scene = ball_scene(triangles);
  scene->cloths[0].material = load_material("11oz-black-denim", "");
  return scene;
}

bool same_yarns(const Snapshot& a, const Snapshot& b) {
  return std::ranges::equal(a.yarns, b.yarns, [](const FaceYarns& x, const FaceYarns& y) {
    return std::ranges::equal(x.curvature, y.curvature) && x.shear == y.shear;
  });
}

TEST_P(Builds, RubbingYarnsGoOnFromASnapshotAndAreRefusedWithTheirStep) {
  const auto scene = denim_scene(150);
  const auto simulator = make(scene);
  run_cleanly(*simulator, 20);
  const Snapshot middle = simulator->snapshot();
  ASSERT_EQ(middle.yarns.size(), scene->cloths[0].mesh.faces.size());
  const auto other = make(scene);
  other->restore(middle);
  EXPECT_TRUE(same_yarns(other->snapshot(), middle));
  for (int k = 0; k < 5; ++k) EXPECT_EQ(simulator->step({}).state_hash, other->step({}).state_hash);

  Parameters wrong = other->parameters();
  wrong.gravity.y = std::numeric_limits<double>::quiet_NaN();
  other->set_parameters(wrong);
  const Snapshot before = other->snapshot();
  EXPECT_FALSE(other->step({}).accepted);
  EXPECT_TRUE(same_yarns(other->snapshot(), before));

  Snapshot of_another = middle;
  of_another.yarns.pop_back();
  EXPECT_THROW(other->restore(of_another), std::invalid_argument);
  // Without its yarns it goes on as well, from where they are at ease.
  other->set_parameters(scene->parameters);
  const std::uint64_t hash = [&] {
    other->restore(middle);
    return other->step({}).state_hash;
  }();
  Snapshot eased = middle;
  eased.yarns.clear();
  other->restore(eased);
  EXPECT_NE(other->step({}).state_hash, hash);
  EXPECT_EQ(other->snapshot().yarns.size(), middle.yarns.size());
}

/// A recording holds what the parameters are in each step, not what they were in between.
TEST_P(Builds, SettingsTriedBetweenTwoStepsLeaveNoTraceInTheYarns) {
  const auto scene = denim_scene(150);
  const auto simulator = make(scene), other = make(scene);
  const auto tried = [&](const std::function<void(Parameters&)>& change) {
    Parameters p = scene->parameters;
    change(p);
    simulator->set_parameters(p);
    const Snapshot meanwhile = simulator->snapshot();
    simulator->restore(meanwhile);
    simulator->set_parameters(scene->parameters);
  };
  for (int k = 0; k < 20; ++k) {
    if (k % 5 == 4) {
      tried([](Parameters& p) { p.material.yarn_friction = 0; });
      tried([](Parameters& p) { p.material.bend_scale = 0; });
      tried([](Parameters& p) { p.material.bending = BendingModel::hinge; });
      other->set_parameters(scene->parameters);  // drops the boxes of the broad phase alike
    }
    ASSERT_EQ(simulator->step({}).state_hash, other->step({}).state_hash) << k;
  }
}

/// A state of single hinges, which know no curvatures, goes on with plates as the live switch does.
TEST_P(Builds, YarnsOfSingleHingesLearnCurvaturesWhereverTheyComeFrom) {
  const auto scene = denim_scene(150);
  const auto live = make(scene), other = make(scene);
  Parameters hinges = scene->parameters;
  hinges.material.bending = BendingModel::hinge;
  live->set_parameters(hinges);
  run_cleanly(*live, 20);
  const Snapshot middle = live->snapshot();
  EXPECT_FALSE(middle.yarns_bend);
  run_cleanly(*other, 3);
  other->restore(middle);
  live->set_parameters(scene->parameters);
  EXPECT_EQ(live->step({}).state_hash, other->step({}).state_hash);
  EXPECT_TRUE(live->snapshot().yarns_bend);
}

TEST_P(Builds, FrictionOfYarnsCanBeSwitchedAndOffIsNotThere) {
  auto elastic = denim_scene(150);
  Material& plain = elastic->cloths[0].material;
  plain.bending_friction = plain.shear_friction = 0;
  const auto simulator = make(denim_scene(150)), other = make(elastic);
  Parameters off = simulator->parameters();
  off.material.yarn_friction = 0;
  simulator->set_parameters(off);
  for (int k = 0; k < 20; ++k)
    EXPECT_EQ(simulator->step({}).state_hash, other->step({}).state_hash);
  EXPECT_TRUE(simulator->snapshot().yarns.empty());
  // Single hinges know no curvature of a face. Only shear has friction with them, and bending when
  // the plates come back.
  for (const BendingModel model : {BendingModel::hinge, BendingModel::plate}) {
    Parameters on = off;
    on.material.yarn_friction = 1;
    on.material.bending = model;
    simulator->set_parameters(on);
    run_cleanly(*simulator, 5);
    double bent = 0;
    for (const FaceYarns& y : simulator->snapshot().yarns) bent += std::fabs(y.curvature[0]);
    EXPECT_EQ(bent > 0, model == BendingModel::plate);
  }
}

TEST_P(Builds, BendingSamplesFurtherApartAreSeen) {
  std::vector<std::uint64_t> hashes;
  for (const double spacing : {20.0, 10.0}) {
    auto scene = denim_scene(150);
    scene->cloths[0].material.bending_spacing = spacing;
    const auto simulator = make(scene);
    run_cleanly(*simulator, 20);
    hashes.push_back(simulator->state_hash());
  }
  EXPECT_NE(hashes[0], hashes[1]);
}

TEST_P(Builds, YarnsThatRubAHundredTimesAsHardHoldTheClothUp) {
  auto scene = denim_scene(150);
  const auto drop = [&](double friction) {
    scene->parameters.material.yarn_friction = friction;
    const auto simulator = make(std::make_shared<Scene>(*scene));
    run_cleanly(*simulator, 60);
    double lowest = 1;
    for (std::size_t i = 0; i < scene->cloths[0].mesh.positions.size(); ++i)
      lowest = std::min(lowest, simulator->snapshot().x1[i].y);
    return 0.112 - lowest;
  };
  const double elastic = drop(0), stiff = drop(100);
  EXPECT_GT(elastic, 0.1);
  EXPECT_LT(stiff, 0.5 * elastic);
}

TEST_P(Builds, AGrabbedSheetFollowsTheHandUntilReleased) {
  auto scene = new_scene();
  scene->cloths.push_back(make_sheet(lying(0.2, 100), {}));
  const auto simulator = make(scene);
  const std::size_t vertices = scene->cloths[0].mesh.positions.size();
  InputEvent grab;
  grab.handle = 7;
  grab.face = 50;
  grab.barycentric = {0.2, 0.3, 0.5};
  const Triangle& f = scene->cloths[0].mesh.faces[50];
  const std::vector<Vec3d>& x = scene->cloths[0].mesh.positions;
  grab.target = 0.2 * x[at(f[0])] + 0.3 * x[at(f[1])] + 0.5 * x[at(f[2])];
  simulator->step(std::vector{grab});
  ASSERT_EQ(simulator->handles().size(), 1u);
  InputEvent move;
  move.kind = InputEvent::Kind::move;
  move.handle = 7;
  for (int k = 1; k <= 50; ++k) {
    move.target = grab.target + Vec3d{0.006 * k, 0.002 * k, 0};
    ASSERT_TRUE(simulator->step(std::vector{move}).accepted);
  }
  for (int k = 0; k < 20; ++k) simulator->step({});
  const HandleState held = simulator->handles().at(0);
  EXPECT_EQ(held.id, 7);
  EXPECT_LT(norm(held.hit - held.target), 0.01);
  EXPECT_GT(mean_position(*simulator, vertices).x, 0.15);

  InputEvent release;
  release.kind = InputEvent::Kind::release;
  release.handle = 7;
  const double before = mean_position(*simulator, vertices).y;
  simulator->step(std::vector{release});
  EXPECT_TRUE(simulator->handles().empty());
  for (int k = 0; k < 30; ++k) simulator->step({});
  EXPECT_LT(mean_position(*simulator, vertices).y, before - 0.2);
}

/// Slide of a sheet on a box tilted by tan α = 0.3, in half a second [m].
double slide(std::unique_ptr<Simulator> simulator) {
  const std::size_t vertices = simulator->scene().cloths[0].mesh.positions.size();
  for (int k = 0; k < 10; ++k) simulator->step({});  // lies down
  const Vec3d start = mean_position(*simulator, vertices);
  for (int k = 0; k < 50; ++k) EXPECT_TRUE(simulator->step({}).accepted);
  return norm(mean_position(*simulator, vertices) - start);
}

TEST_P(Builds, FrictionHoldsOnASlope) {
  const auto scene_with = [](double friction) {
    auto scene = new_scene();
    const double angle = std::atan(0.3), c = std::cos(angle), s = std::sin(angle);
    const auto tilt = [&](Vec3d p) { return Vec3d{c * p.x - s * p.y, s * p.x + c * p.y, p.z}; };
    scene->cloths.push_back(make_sheet(lying(0.15, 100), {0, 0.011, 0}));
    scene->obstacles.push_back(make_obstacle(make_box({0.8, 0.02, 0.3}, 0.1), {}));
    for (Vec3d& p : scene->cloths[0].mesh.positions) p = tilt(p);
    for (Vec3d& p : scene->obstacles[0].mesh.positions) p = tilt(p);
    scene->parameters.proximity.friction_obstacle = friction;
    return scene;
  };
  EXPECT_LT(slide(make(scene_with(0.6))), 0.002);
  // Coulomb's law alone gives ½ (g sin α − μ g cos α) t² = 0.23 m, from rest.
  EXPECT_GT(slide(make(scene_with(0.1))), 0.1);
}

/// Three sheets side by side on slopes of tan α = 0.3, each with its own friction or none.
std::shared_ptr<Scene> slopes(const std::array<std::optional<double>, 3>& friction) {
  auto scene = new_scene();
  const double angle = std::atan(0.3), c = std::cos(angle), s = std::sin(angle);
  for (std::size_t k = 0; k < 3; ++k) {
    const double z = 0.4 * static_cast<double>(k);
    scene->cloths.push_back(make_sheet(lying(0.15, 60), {0, 0.011, z}));
    scene->obstacles.push_back(make_obstacle(make_box({0.8, 0.02, 0.3}, 0.1), {0, 0, z}));
    scene->obstacles[k].friction = friction[k];
    for (auto* mesh : {&scene->cloths[k].mesh, &scene->obstacles[k].mesh})
      for (Vec3d& p : mesh->positions) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  }
  return scene;
}

/// How far each sheet goes in the steps [m].
std::array<double, 3> ways(Simulator& simulator, int steps) {
  const std::size_t each = simulator.scene().cloths[0].mesh.positions.size();
  const std::vector<Vec3d> start = simulator.snapshot().x1;
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(simulator.step({}).accepted);
  const std::vector<Vec3d> end = simulator.snapshot().x1;
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3 * each; ++i)
    out[i / each] += norm(end[i] - start[i]) / static_cast<double>(each);
  return out;
}

TEST_P(Builds, EveryBodyHasItsOwnFriction) {
  auto scene = slopes({0.6, 0.1, std::nullopt});
  scene->parameters.proximity.friction_cloth = 0;
  scene->parameters.proximity.friction_obstacle = 0.6;
  const auto simulator = make(scene);
  ways(*simulator, 10);  // they lie down
  const auto first = ways(*simulator, 30);
  EXPECT_LT(first[0], 0.002);
  EXPECT_GT(first[1], 0.03);
  EXPECT_LT(first[2], 0.002);
  Parameters smooth = simulator->parameters();
  smooth.proximity.friction_obstacle = 0;  // of the third body alone
  simulator->set_parameters(smooth);
  const auto second = ways(*simulator, 30);
  EXPECT_LT(second[0], 0.002);
  EXPECT_GT(second[1], 0.05);
  EXPECT_GT(second[2], 0.05);
}

/// A refused step keeps the state before it bit for bit, and says why.
void expect_refused(Simulator& simulator, bool finite) {
  const Snapshot before = simulator.snapshot();
  const std::uint64_t hash = simulator.state_hash();
  const StepReport report = simulator.step({});
  EXPECT_FALSE(report.accepted);
  EXPECT_EQ(report.finite, finite);
  EXPECT_GT(report.retries, 0);
  EXPECT_TRUE(same_state(simulator.snapshot(), before));
  EXPECT_EQ(simulator.state_hash(), hash);
  EXPECT_EQ(report.state_hash, hash);
  if (!finite) return;
  ASSERT_FALSE(report.offending.empty());
  EXPECT_LE(report.offending.size(), 100u);
  const auto vertices = static_cast<Index>(before.x1.size());
  for (const OffendingPair& pair : report.offending)
    for (const Index v : pair.vertices) EXPECT_TRUE(v >= 0 && v < vertices);
}

/// A ball that moves through the pinned border of a hanging sheet.
std::shared_ptr<Scene> pinned_scene() {
  auto scene = new_scene();
  const GridShape shape = hanging(0.2, 100);
  scene->cloths.push_back(make_sheet(shape, {0.003, 0, 0}));
  scene->cloths[0].pins = grid_vertices(make_grid(shape), "top");
  scene->obstacles.push_back(make_obstacle(make_sphere(0.03, 320), {0, 0.1, 0}));
  scene->obstacles[0].motion = {{0, {0, 0, -0.05}, {}}, {0.2, {0, 0, 0.05}, {}}};
  return scene;
}

TEST_P(Builds, ABodyPushedIntoPinsIsRefused) {
  const auto simulator = make(pinned_scene());
  bool refused = false;
  for (int k = 0; k < 20 && !refused; ++k) {
    const Snapshot before = simulator->snapshot();
    const StepReport report = simulator->step({});
    refused = !report.accepted;
    EXPECT_EQ(report.no_room, refused);
    EXPECT_EQ(count_intersections(*simulator), 0u) << k;
    EXPECT_TRUE(!refused || same_state(simulator->snapshot(), before));
  }
  ASSERT_TRUE(refused);
  expect_refused(*simulator, true);
}

TEST_P(Builds, NumbersThatAreNotFiniteAreRefused) {
  const auto simulator = make(ball_scene(100));
  for (int k = 0; k < 5; ++k) simulator->step({});
  Parameters wrong = simulator->parameters();
  const Parameters sane = wrong;
  for (const double gravity :
       {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    wrong.gravity.y = gravity;
    simulator->set_parameters(wrong);
    expect_refused(*simulator, false);
  }
  // And goes on as if nothing had happened.
  simulator->set_parameters(sane);
  EXPECT_TRUE(simulator->step({}).accepted);
}

TEST_P(Builds, HugeForcesNeverPullTheClothThroughABody) {
  const auto simulator = make(ball_scene(60));
  Parameters huge = simulator->parameters();
  huge.gravity.y = -1e9;
  simulator->set_parameters(huge);
  const Snapshot before = simulator->snapshot();
  const StepReport report = simulator->step({});
  EXPECT_GT(report.substeps + report.retries, 10);
  EXPECT_EQ(count_intersections(*simulator), 0u);
  EXPECT_EQ(report.accepted, !same_state(simulator->snapshot(), before));
}

class Threads : public ::testing::TestWithParam<Build> {
 protected:
  void TearDown() override { set_thread_count(0); }
};

INSTANTIATE_TEST_SUITE_P(Step, Threads, ::testing::Values(Build::cpu32, Build::cpu64),
                         [](const auto& instance) {
                           return std::string(build_name(instance.param));
                         });

TEST_P(Threads, DoNotChangeABit) {
  auto scene = ball_scene(600);
  scene->cloths.push_back(make_sheet(lying(0.3, 300), {-0.01, 0.13, 0.01}));
  std::vector<std::vector<std::uint64_t>> hashes;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const auto simulator = make_simulator(GetParam(), scene);
    hashes.emplace_back();
    for (int k = 0; k < 60; ++k) hashes.back().push_back(simulator->step({}).state_hash);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace icloth
