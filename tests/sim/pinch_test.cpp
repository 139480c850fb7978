// Cloth between bodies that overlap: what is let go, what is kept, and that it comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/bodies/cached_poses.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::hanging;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;

/// A moment at which bodies are at their closest, and the time at which they are apart again.
constexpr double kClosest = 0.2, kApart = 0.4;

std::shared_ptr<Scene> new_scene() {
  auto scene = std::make_shared<Scene>();
  scene->name = "pinch";
  scene->parameters.wind.air_density = 0;
  return scene;
}

/// A body that moves by `way` until kClosest and back until kApart.
void add_body(Scene& scene, TriangleMesh mesh, Vec3d centre, Vec3d way) {
  scene.obstacles.push_back(make_obstacle(std::move(mesh), centre));
  if (norm2(way) > 0)
    scene.obstacles.back().motion = {{0, {}, {}}, {kClosest, way, {}}, {kApart, {}, {}}};
}

/// Pairs of faces that intersect: among cloths alone, and with bodies.
struct Crossings {
  std::size_t cloth = 0, bodies = 0;
};

Crossings crossings(const Simulator& simulator) {
  const Scene& scene = simulator.scene();
  const SceneFaces soup = scene_faces(scene);
  const auto cloth_faces = std::ranges::count_if(soup.group, [](int g) { return g >= 0; });

  // The faces of the cloths come first, and a pair names the lower one first.
  Crossings found;
  for (const auto& pair : find_intersections(simulator.snapshot().x1, soup.faces, soup.group))
    ++(pair.b < cloth_faces ? found.cloth : found.bodies);
  return found;
}

/// Runs until some time after the bodies are apart: every step is accepted, the cloth never crosses
/// itself, it is pinched for a while, and nothing is left of it in the end.
void expect_pinched_for_a_while(const std::shared_ptr<Scene>& scene, Build build) {
  const auto simulator = make_simulator(build, scene);
  const int steps = static_cast<int>(std::lround(2 * kApart / scene->parameters.step.time_step));
  std::int64_t most = 0;
  StepReport report;
  for (int k = 0; k < steps; ++k) {
    report = simulator->step({});
    ASSERT_TRUE(report.accepted) << k;
    ASSERT_EQ(crossings(*simulator).cloth, 0u) << k;
    if (report.pinched == 0) {
      ASSERT_EQ(crossings(*simulator).bodies, 0u) << k;
    }
    most = std::max(most, report.pinched);
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(most, static_cast<std::int64_t>(scene->cloths[0].mesh.positions.size()));
  EXPECT_EQ(report.pinched, 0);
  EXPECT_EQ(crossings(*simulator).bodies, 0u);
}

std::shared_ptr<Scene> spheres(double overlap) {
  auto scene = new_scene();
  GridShape shape = hanging(0.2, 200);
  scene->cloths.push_back(make_sheet(shape, {0.003, 0, 0}));
  scene->cloths[0].pins = grid_vertices(make_grid(shape), "top");
  for (const double side : {-1.0, 1.0})
    add_body(*scene, make_sphere(0.04, 320), {0, -0.01, side * 0.06},
             {0, 0, -side * (0.02 + overlap / 2)});
  return scene;
}

class Pinch : public ::testing::TestWithParam<Build> {};

INSTANTIATE_TEST_SUITE_P(Builds, Pinch, ::testing::Values(Build::cpu32, Build::cpu64),
                         [](const auto& instance) {
                           return std::string(build_name(instance.param));
                         });

TEST_P(Pinch, SpheresThatOverlapALittleOrMuchLetTheClothGoAndTakeItBack) {
  for (const double overlap : {0.0002, 0.005}) {
    SCOPED_TRACE(overlap);
    expect_pinched_for_a_while(spheres(overlap), GetParam());
  }
}

TEST_P(Pinch, LongBodiesWithTautClothBetween) {
  // At the rim of the pinch the cloth that is squeezed holds back the cloth beside it.
  for (const double overlap : {0.01, 0.025}) {
    SCOPED_TRACE(overlap);
    auto scene = new_scene();
    scene->parameters.step.time_step = 0.005;
    GridShape shape = hanging(0.5, overlap < 0.02 ? 500 : 1000);
    shape.width = 0.3;
    scene->cloths.push_back(make_sheet(shape, {0, 0.05, 0}));
    scene->cloths[0].pins = grid_vertices(make_grid(shape), "top");
    for (const double side : {-1.0, 1.0})
      add_body(*scene, make_capsule(0.05, 0.4, 400), {0, 0, side * 0.07},
               {0, 0, -side * (0.02 + overlap / 2)});
    expect_pinched_for_a_while(scene, GetParam());
  }
}

TEST_P(Pinch, ABodyAgainstTheFloor) {
  auto scene = new_scene();
  scene->cloths.push_back(make_sheet(lying(0.2, 200), {0, 0.002, 0}));
  scene->obstacles.push_back(make_obstacle(make_plane(0.5, 0.5, 0.05), {}));
  add_body(*scene, make_sphere(0.05, 320), {0.01, 0.08, 0}, {0, -0.033, 0});
  expect_pinched_for_a_while(scene, GetParam());
}

TEST_P(Pinch, ThreeBodiesThatMeet) {
  auto scene = new_scene();
  scene->parameters.gravity.y = 0;
  scene->cloths.push_back(make_sheet(lying(0.2, 200), {}));
  add_body(*scene, make_sphere(0.05, 320), {-0.045, 0.08, 0}, {0, -0.034, 0});
  add_body(*scene, make_sphere(0.05, 320), {0.045, 0.08, 0}, {0, -0.034, 0});
  add_body(*scene, make_box({0.2, 0.04, 0.2}, 0.05), {0, -0.022, 0}, {});
  expect_pinched_for_a_while(scene, GetParam());
}

/// Two spheres in one mesh, in a point cache: parts of one body that overlap each other.
TEST_P(Pinch, PartsOfOneBodyThatOverlap) {
  auto scene = spheres(0.0);
  std::vector<Obstacle> two = std::move(scene->obstacles);
  TriangleMesh both = two[0].mesh;
  const auto first = static_cast<Index>(both.positions.size());
  for (const Triangle& t : two[1].mesh.faces)
    both.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
  both.positions.insert(both.positions.end(), two[1].mesh.positions.begin(),
                        two[1].mesh.positions.end());
  Obstacle body = make_obstacle(both, {});
  std::vector<std::vector<Vec3f>> frames;
  for (int k = 0; k <= 40; ++k) {
    const double close = 1 - std::fabs(k / 20.0 - 1);  // 0 to 1 to 0
    frames.emplace_back();
    for (std::size_t i = 0; i < both.positions.size(); ++i) {
      const double side = static_cast<Index>(i) < first ? 1 : -1;
      frames.back().push_back(
          convert<float>(both.positions[i] + Vec3d{0, 0, side * 0.0215 * close}));
    }
  }
  body.poses = std::make_shared<CachedPoses>(std::move(frames), 100);
  scene->obstacles = {body};
  expect_pinched_for_a_while(scene, GetParam());
}

TEST_P(Pinch, RoomForTheClothIsNeverTaken) {
  auto scene = new_scene();
  scene->parameters.gravity.y = 0;
  scene->cloths.push_back(make_sheet(lying(0.1, 60), {}));
  for (const double side : {-1.0, 1.0})
    add_body(*scene, make_box({0.2, 0.02, 0.2}, 0.1), {0, side * 0.02, 0}, {0, side * -0.0098, 0});
  const auto simulator = make_simulator(GetParam(), scene);
  for (int k = 0; k < 50; ++k) {
    const StepReport report = simulator->step({});
    ASSERT_TRUE(report.accepted) << k;
    ASSERT_EQ(report.pinched, 0) << k;
    ASSERT_EQ(crossings(*simulator).bodies, 0u) << k;
  }
}

TEST_P(Pinch, WhatIsLetGoIsPartOfTheState) {
  const auto scene = spheres(0.002);
  const auto simulator = make_simulator(GetParam(), scene);
  StepReport report;
  for (int k = 0; k < 40 && report.pinched == 0; ++k) report = simulator->step({});
  ASSERT_GT(report.pinched, 0);
  const Snapshot middle = simulator->snapshot();
  EXPECT_FALSE(middle.let_go.empty());
  std::vector<std::uint64_t> expected;
  for (int k = 0; k < 30; ++k) expected.push_back(simulator->step({}).state_hash);
  const auto other = make_simulator(GetParam(), scene);
  other->restore(middle);
  for (const std::uint64_t hash : expected) ASSERT_EQ(other->step({}).state_hash, hash);
}

TEST_P(Pinch, TheClockGoesOnOverARefusedStep) {
  // A ball moves through pinned vertices: no step while it does so can be accepted.
  auto scene = new_scene();
  GridShape shape = hanging(0.2, 200);
  scene->cloths.push_back(make_sheet(shape, {0.003, 0, 0}));
  scene->cloths[0].pins = grid_vertices(make_grid(shape), "top");
  scene->obstacles.push_back(make_obstacle(make_sphere(0.03, 320), {0, 0.1, 0}));
  scene->obstacles[0].motion = {{0, {0, 0, -0.1}, {}}, {0.4, {0, 0, 0.3}, {}}};
  const auto simulator = make_simulator(GetParam(), scene);

  int refused = 0, crossed = 0;
  for (int k = 0; k < 80; ++k) {
    const double before = simulator->time();
    if (!simulator->step({}).accepted) {
      ++refused;
      ASSERT_EQ(simulator->time(), before);
      simulator->pass_over();
    }
    ASSERT_NEAR(simulator->time(), before + scene->parameters.step.time_step, 1e-12);
    ASSERT_EQ(simulator->step_index(), k + 1);
    const Crossings now = crossings(*simulator);
    ASSERT_EQ(now.cloth, 0u) << k;
    if (now.bodies > 0) ++crossed;
    // Crossings with bodies are never without vertices that are told to be let go.
    ASSERT_TRUE(now.bodies == 0 || !simulator->snapshot().let_go.empty()) << k;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 40);
  EXPECT_GT(crossed, 0);
  EXPECT_EQ(crossings(*simulator).bodies, 0u);
  EXPECT_TRUE(simulator->snapshot().let_go.empty());
}

}  // namespace
}  // namespace icloth
