// Start states that intersect a little are separated, and can be simulated then.
#include "sim/scene/repair.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/scene/contours.h"
#include "sim/scene/intersections.h"
#include "sim/scene/repair_sides.h"
#include "sim/simulator.h"
#include "tests/support/crossing_sheets.h"

namespace icloth {
namespace {

using testing::expect_repaired;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;
using testing::shaped_sheet;

TEST(Repair, MovesASheetOutOfABall) {
  Scene scene;
  scene.cloths.push_back(make_sheet(lying(0.3, 800), {0, 0.097, 0}));
  scene.obstacles.push_back(make_obstacle(make_sphere(0.1, 500), {}));
  ASSERT_GT(find_start_intersections(scene, true).size(), 10u);
  const std::vector<Vec3d> rest = scene.cloths[0].rest;
  const StartRepair repair = repair_start(scene, 0.02);
  EXPECT_GT(repair.pairs_before, 10u);
  EXPECT_EQ(repair.pairs_left, 0u);
  EXPECT_GT(repair.moved, 5u);
  EXPECT_LT(repair.largest_move, 0.01);
  EXPECT_TRUE(find_start_intersections(scene, true).empty());
  EXPECT_TRUE(scene.cloths[0].rest == rest) << "the rest shape stays";
  for (const Vec3d& p : scene.cloths[0].mesh.positions)
    EXPECT_GT(norm(p), 0.0985) << "out of the body, not further in";
}

/// A small dent of the upper sheet pokes through the lower one.
TEST(Repair, PullsADentBackAndTheSheetsCanBeSimulated) {
  auto scene = std::make_shared<Scene>();
  scene->cloths.push_back(make_sheet(lying(0.2, 400), {}));
  scene->cloths.push_back(make_sheet(lying(0.2, 400), {0.003, 0.002, 0.002}));
  for (Vec3d& p : scene->cloths[1].mesh.positions)
    if (std::hypot(p.x, p.z) < 0.009) p.y -= 0.003;
  ASSERT_FALSE(find_start_intersections(*scene, true).empty());
  EXPECT_EQ(repair_start(*scene, 0.01).pairs_left, 0u);
  const auto simulator = make_simulator(Build::cpu32, scene);
  for (int step = 0; step < 10; ++step) EXPECT_TRUE(simulator->step({}).accepted);
}

TEST(Repair, LeavesWhatIsTooDeepAndWhatIsClean) {
  Scene deep;
  deep.cloths.push_back(make_sheet(lying(0.3, 200), {}));
  deep.obstacles.push_back(make_obstacle(make_sphere(0.1, 500), {}));
  const StartRepair repair = repair_start(deep, 0.005);
  EXPECT_GT(repair.pairs_left, 0u);
  EXPECT_LE(repair.largest_move, 0.005 + 1e-12);

  Scene clean;
  clean.cloths.push_back(make_sheet(lying(0.3, 200), {}));
  const std::vector<Vec3d> before = clean.cloths[0].mesh.positions;
  EXPECT_EQ(repair_start(clean, 0.01).moved, 0u);
  EXPECT_TRUE(clean.cloths[0].mesh.positions == before);
}

TEST(Repair, PartsSheetsThatCrossAlongALine) {
  // The two sheets lie at an angle; the deepest place is at their borders.
  for (const double depth : {0.13e-3, 0.26e-3, 1e-3}) {
    Scene scene;
    scene.cloths.push_back(make_sheet(lying(0.2, 200), {}));
    scene.cloths.push_back(shaped_sheet(0.2, 200, [&](Vec3d p) {
      return Vec3d{p.x + 0.003, depth * p.x / 0.1, p.z + 0.004};
    }));
    expect_repaired(scene, 1.05 * depth, "free");

    // With one of them held, the other has to go the whole way.
    for (std::size_t v = 0; v < scene.cloths[0].mesh.positions.size(); ++v)
      scene.cloths[0].pins.push_back(static_cast<Index>(v));
    expect_repaired(scene, 1.05 * depth, "pinned");
  }
}

TEST(Repair, PullsABumpBack) {
  Scene scene;
  scene.cloths.push_back(make_sheet(lying(0.2, 500), {}));
  scene.cloths.push_back(shaped_sheet(0.2, 700, [](Vec3d p) {
    const double r = std::hypot(p.x - 0.01, p.z + 0.02) / 0.05;
    return Vec3d{p.x + 0.002, 0.0005 - 0.0015 * std::max(0.0, 1 - r * r), p.z + 0.003};
  }));
  const Scene before = scene;
  expect_repaired(scene, 1e-3, "bump");

  // The bump goes back, and not all the rest of the sheet through the other one.
  repair_start(scene, 0.015);
  const Vec3d corner = before.cloths[1].mesh.positions[0];
  EXPECT_TRUE(scene.cloths[1].mesh.positions[0] == corner);
}

TEST(Repair, PartsWavesAndThreeLayers) {
  Scene waves;
  waves.cloths.push_back(make_sheet(lying(0.2, 500), {}));
  waves.cloths.push_back(shaped_sheet(0.2, 700, [](Vec3d p) {
    return Vec3d{p.x + 0.002, 3e-4 * std::sin(60 * p.x) * std::cos(50 * p.z), p.z + 0.003};
  }));
  expect_repaired(waves, 3e-4, "waves");

  Scene layers;
  layers.cloths.push_back(make_sheet(lying(0.2, 200), {}));
  layers.cloths.push_back(shaped_sheet(0.2, 242, [](Vec3d p) {
    return Vec3d{p.x + 0.002, 3e-4 * p.z / 0.1, p.z + 0.003};
  }));
  layers.cloths.push_back(shaped_sheet(0.2, 288, [](Vec3d p) {
    return Vec3d{p.x - 0.001, 1e-4 + 3e-4 * p.x / 0.1, p.z - 0.002};
  }));
  expect_repaired(layers, 7e-4, "three layers");
}

TEST(Repair, PartsALayerFromTheOneThatItIsFoldedOver) {
  // A strip turned over itself with a radius of 4 mm; the end of the upper layer goes through the
  // lower one.
  Scene scene;
  scene.cloths.push_back(shaped_sheet(0.2, 3200, [](Vec3d p) {
    const double radius = 0.004, bow = 3.14159265 * radius / 2;
    if (p.x < -bow) return Vec3d{p.x + bow, 0, p.z};
    if (p.x > bow)
      return Vec3d{bow - p.x, 2 * radius - (2 * radius + 4e-4) * std::min(1.0, (p.x - bow) / 0.08),
                   p.z};
    return Vec3d{radius * std::cos(p.x / radius), radius + radius * std::sin(p.x / radius), p.z};
  }));
  expect_repaired(scene, 5e-4, "fold");
}

TEST(Repair, PartsSheetsThatMeetAtACornerOrABorder) {
  Scene corner;
  corner.cloths.push_back(make_sheet(lying(0.2, 200), {}));
  corner.cloths.push_back(shaped_sheet(0.2, 242, [](Vec3d p) {
    return Vec3d{p.x + 0.185, 0.005 * (p.x + p.z + 0.19), p.z + 0.18};
  }));
  expect_repaired(corner, 1e-4, "corner");

  Scene border;  // an upright sheet that goes through a lying one with its lower border
  border.cloths.push_back(make_sheet(lying(0.2, 200), {}));
  border.cloths.push_back(shaped_sheet(0.2, 242, [](Vec3d p) {
    return Vec3d{0.8 * p.x, p.z + 0.1 - 2e-4, 0.003 + 0.1 * p.x};
  }));
  expect_repaired(border, 2e-4, "border");
}

TEST(Repair, MovesASheetOffTheTopAndTheRidgeOfABox) {
  const double depth = 5e-4, half = 0.05;
  Scene top;
  top.cloths.push_back(make_sheet(lying(0.2, 200), {}));
  top.obstacles.push_back(make_obstacle(make_box({0.1, 0.1, 0.1}, 2), {0.06, depth - half, 0.03}));
  expect_repaired(top, depth, "top");

  Scene ridge = top;
  for (Vec3d& p : ridge.obstacles[0].mesh.positions) {
    const Vec3d q = p - Vec3d{0.06, depth - half, 0.03};
    const double s = std::sqrt(0.5);
    p = {s * (q.x - q.y), s * (q.x + q.y) + depth - half / s, q.z};
  }
  expect_repaired(ridge, depth, "ridge");
}

TEST(Repair, LeavesSheetsThatLieInEachOther) {
  Scene scene;
  scene.cloths = {make_sheet(lying(0.2, 50), {}), make_sheet(lying(0.2, 72), {0.001, 0, 0.001})};
  const StartRepair repair = repair_start(scene, 0.015);
  EXPECT_GT(repair.pairs_left, 0u);
  EXPECT_EQ(repair.moved, 0u) << "no side is known";
}

TEST(Contours, TheContourOfABumpClosesOnBothSheets) {
  Scene scene;
  scene.cloths.push_back(make_sheet(lying(0.2, 500), {}));
  scene.cloths.push_back(shaped_sheet(0.2, 700, [](Vec3d p) {
    const double r = std::hypot(p.x - 0.01, p.z + 0.02) / 0.05;
    return Vec3d{p.x + 0.002, 0.0005 - 0.0015 * std::max(0.0, 1 - r * r), p.z + 0.003};
  }));
  const RepairMesh mesh(scene);
  const auto pairs = find_intersections(mesh.x, mesh.faces, mesh.group);
  const std::vector<Contour> contours = trace_contours(mesh, pairs);
  ASSERT_EQ(contours.size(), 2u) << "one contour, seen by both sheets";
  EXPECT_EQ(contours[0].twin, 1u);
  EXPECT_EQ(contours[1].twin, 0u);
  EXPECT_EQ(contours[0].segments.size(), pairs.size());
  // A closed contour has as many corners as segments.
  EXPECT_EQ(contours[0].piercings.size() + contours[1].piercings.size(), pairs.size());

  // The bump is what is wrong: all its vertices below the flat sheet, and no others.
  const std::vector<Side> sides = choose_sides(mesh, contours, 0.015);
  const std::size_t flat = scene.cloths[0].mesh.positions.size();
  std::size_t below = 0;
  for (const Vec3d& p : scene.cloths[1].mesh.positions) below += p.y < 0 ? 1 : 0;
  const std::size_t bump = contours[0].segments[0].own < contours[0].segments[0].other ? 1 : 0;
  EXPECT_EQ(sides[bump].wrong.size(), below);
  for (const WrongVertex& w : sides[bump].wrong) {
    const Vec3d p = mesh.position(w.vertex);
    EXPECT_GE(static_cast<std::size_t>(w.vertex), flat);
    EXPECT_NEAR(w.depth, -p.y, 1e-9);
  }
}

}  // namespace
}  // namespace icloth
