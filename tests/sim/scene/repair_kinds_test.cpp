// The repair of start states, one kind of crossing after the other.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <random>

#include "sim/scene/repair_clusters.h"
#include "sim/scene/scene_io.h"
#include "tests/support/crossing_sheets.h"

namespace icloth {
namespace {

using testing::expect_repaired;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;
using testing::shaped_sheet;

Vec3d as_it_is(Vec3d p) { return p; }

Scene diagonal_sheets(double depth) {
  Scene scene;
  scene.cloths.push_back(shaped_sheet(0.2, 300, as_it_is));
  scene.cloths.push_back(shaped_sheet(0.2, 400, [&](Vec3d p) {
    return Vec3d{p.x + 0.003, depth * (0.6 * p.x + 0.4 * p.z + 0.02) / 0.1, p.z - 0.004};
  }));
  return scene;
}

TEST(RepairKinds, PartsSheetsAcrossEachOtherAtEveryDepth) {
  for (const double depth : {0.5e-3, 1e-3, 3e-3})
    expect_repaired(diagonal_sheets(depth), 1.3 * depth, "diagonal");

  // Flatter ones are closer than the offset also far from where they cross.
  for (const double depth : {0.05e-3, 0.13e-3, 0.26e-3}) {
    Scene scene = diagonal_sheets(depth);
    const StartRepair repair = repair_start(scene, 0.015);
    EXPECT_GT(repair.pairs_before, 20u);
    EXPECT_EQ(repair.pairs_left, 0u);
    EXPECT_TRUE(find_start_intersections(scene, true).empty());
    EXPECT_LE(repair.largest_move, 1.3 * depth + scene.parameters.impact_zones.offset);
  }
}

/// A sheet from 0.5 mm above y = 0 that dips below it by `depth` around a point, over `radius`.
Cloth bump(Index triangles, double depth, double radius, Vec3d middle, double shift) {
  return shaped_sheet(0.2, triangles, [=](Vec3d p) {
    const double r = std::hypot(p.x - middle.x, p.z - middle.z) / radius;
    return Vec3d{p.x + shift, 0.0005 - (depth + 0.0005) * std::max(0.0, 1 - r * r), p.z + 0.003};
  });
}

TEST(RepairKinds, PullsBackABumpInTheMiddleAndOneThatABorderCuts) {
  for (const double depth : {0.05e-3, 0.26e-3, 2e-3}) {
    Scene closed;
    closed.cloths = {make_sheet(lying(0.2, 500), {}),
                     bump(700, depth, 0.05, {0.01, 0, 0.02}, 0.002)};
    expect_repaired(closed, depth, "closed contour");

    // The contour ends at the border of the bump's own sheet, halfway over the other one.
    Scene open;
    open.cloths = {make_sheet(lying(0.2, 500), {}), bump(600, depth, 0.05, {-0.1, 0, 0.02}, 0.1)};
    expect_repaired(open, depth, "open contour");
  }
}

TEST(RepairKinds, PartsAGrooveThatRunsFromBorderToBorder) {
  for (const double depth : {0.13e-3, 1e-3}) {
    Scene scene;
    scene.cloths.push_back(shaped_sheet(0.2, 500, as_it_is));
    scene.cloths.push_back(shaped_sheet(0.2, 600, [&](Vec3d p) {
      const double t = (p.z - 0.03) / 0.04;
      return Vec3d{p.x + 0.1, 0.0005 - (depth + 0.0005) * std::exp(-t * t), p.z + 0.003};
    }));
    expect_repaired(scene, depth, "groove");
  }
}

TEST(RepairKinds, PartsTubesOfWhichOneLeavesTheOther) {
  const auto tube = [](double radius, double shift, Index triangles) {
    return shaped_sheet(0.2, triangles, [=](Vec3d p) {
      const double angle = p.x / 0.2 * 5.9;
      return Vec3d{radius * std::cos(angle) + shift, p.z, radius * std::sin(angle)};
    });
  };
  Scene scene;
  scene.cloths = {tube(0.03, 0, 1000), tube(0.0285, 0.0025, 1200)};
  expect_repaired(scene, 1.3e-3, "tubes");
}

TEST(RepairKinds, PartsCloseFoldsThatAreDeep) {
  Scene scene;
  scene.cloths.push_back(shaped_sheet(0.2, 3000, [](Vec3d p) {
    const double radius = 0.004, bow = std::numbers::pi * radius / 2;
    if (p.x < -bow) return Vec3d{p.x + bow, 0, p.z};
    if (p.x < bow)
      return Vec3d{radius * std::cos(p.x / radius), radius + radius * std::sin(p.x / radius), p.z};
    const double height = 2 * radius - (2 * radius + 1e-3) * std::min(1.0, (p.x - bow) / 0.08);
    return Vec3d{bow - p.x, height, p.z};
  }));
  const StartRepair repair = repair_start(scene, 0.006);
  EXPECT_GT(repair.pairs_before, 100u);
  EXPECT_EQ(repair.pairs_left, 0u);
  EXPECT_TRUE(find_start_intersections(scene, true).empty());
  EXPECT_LE(repair.largest_move, 1.2e-3);
}

TEST(RepairKinds, PartsLayersOnABodyThatPokesThroughThem) {
  Scene scene;
  scene.cloths.push_back(shaped_sheet(0.2, 500, as_it_is));
  scene.cloths.push_back(shaped_sheet(0.2, 500, [](Vec3d p) {
    return Vec3d{p.x + 0.002, 1e-3 * p.x / 0.1, p.z + 0.003};
  }));
  scene.obstacles.push_back(make_obstacle(make_sphere(0.06, 2000), {0.01, 1e-3 - 0.06, 0.005}));
  expect_repaired(scene, 2e-3, "body");
}

/// Two panels side by side at an angle [°]; 180 is flat, 0 would be one on the other. Their borders
/// cross by `width` in one of three manners.
enum class Teeth { overlap, ragged, frayed };

Scene panels(double angle, double width, Teeth teeth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-width, width);
  const double turn = (180 - angle) * std::numbers::pi / 180;
  const auto panel = [&](int sign, Index triangles) {
    return shaped_sheet(0.2, triangles, [&, sign](Vec3d p) {
      // `u` is the distance from the seam in the panel, `h` the height over it.
      double u = p.x + 0.1, h = 0;
      const bool at_seam = u < 1e-9;
      if (teeth == Teeth::overlap) {
        u -= sign > 0 ? width : 0;
        h = 0.5 * sign * width * std::sin(150 * p.z);
      } else {
        if (teeth == Teeth::ragged && at_seam) u += noise(random);
        if (teeth == Teeth::ragged || at_seam) h = noise(random);
      }
      if (sign < 0) return Vec3d{-u, h, p.z + 0.0007};
      return Vec3d{std::cos(turn) * u - std::sin(turn) * h, std::sin(turn) * u + std::cos(turn) * h,
                   p.z};
    });
  };
  Scene scene;
  scene.cloths.push_back(panel(-1, 500));
  scene.cloths.push_back(panel(1, 625));
  return scene;
}

TEST(RepairKinds, PartsPanelsWhoseBordersCrossLikeTeeth) {
  int crossing = 0;
  for (const double width : {2e-6, 0.02e-3, 0.1e-3, 0.5e-3})
    for (const double angle : {180.0, 135.0, 90.0, 45.0, 20.0})
      for (const Teeth teeth : {Teeth::overlap, Teeth::ragged, Teeth::frayed}) {
        SCOPED_TRACE(::testing::Message()
                     << 1e3 * width << " mm, " << angle << "°, manner " << static_cast<int>(teeth));
        Scene scene = panels(angle, width, teeth);
        if (find_start_intersections(scene, true).empty()) continue;
        ++crossing;
        const StartRepair repair = repair_start(scene, 0.009);
        const double offset = scene.parameters.impact_zones.offset;
        EXPECT_EQ(repair.pairs_left, 0u);
        EXPECT_TRUE(find_start_intersections(scene, true).empty());
        EXPECT_LE(repair.largest_move, 1.02 * (2 * width + offset));
      }
  EXPECT_GT(crossing, 40);
}

TEST(RepairKinds, MovesBordersAlongThePanelsAndNotOutOfThem) {
  const double width = 0.1e-3;
  const Scene before = panels(180, width, Teeth::overlap);
  Scene scene = before;
  ASSERT_EQ(repair_start(scene, 0.009).pairs_left, 0u);
  double along = 0, out = 0;
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t v = 0; v < scene.cloths[c].mesh.positions.size(); ++v) {
      const Vec3d move = scene.cloths[c].mesh.positions[v] - before.cloths[c].mesh.positions[v];
      along = std::max(along, std::fabs(move.x));
      out = std::max(out, std::fabs(move.y));
    }
  EXPECT_GT(along, 0.5 * width);
  EXPECT_LT(out, 0.25 * along);
}

TEST(RepairKinds, PartsOnePlaceAlsoWhereAnotherOneIsTooDeep) {
  // Two sheets cross a little; a third one, far away, is skewered by a body.
  Scene scene;
  scene.cloths = {make_sheet(lying(0.2, 500), {}), bump(700, 1e-3, 0.05, {0.01, 0, 0.02}, 0.002),
                  make_sheet(lying(0.3, 200), {1, 0, 0})};
  scene.obstacles.push_back(make_obstacle(make_sphere(0.1, 500), {1, 0, 0}));
  const StartRepair repair = repair_start(scene, 0.005);
  const auto left = find_start_intersections(scene, true);
  EXPECT_LT(repair.pairs_left, repair.pairs_before);
  EXPECT_EQ(repair.pairs_left, left.size());
  const auto first_face =
      static_cast<Index>(scene.cloths[0].mesh.faces.size() + scene.cloths[1].mesh.faces.size());
  for (const IntersectingFaces& pair : left) EXPECT_GE(pair.a, first_face);
}

std::vector<Vec3d> repaired(const Scene& crossing, double work) {
  Scene scene = crossing;
  const std::size_t before = find_start_intersections(scene, true).size();
  const StartRepair repair = repair_start(scene, 0.015, work);
  EXPECT_LE(repair.pairs_left, before);
  EXPECT_EQ(find_start_intersections(scene, true).size(), repair.pairs_left);
  std::vector<Vec3d> x;
  for (const Cloth& cloth : scene.cloths)
    x.insert(x.end(), cloth.mesh.positions.begin(), cloth.mesh.positions.end());
  return x;
}

TEST(RepairKinds, GivesTheSameBitsWithAnyNumberOfThreads) {
  const Scene scene = panels(135, 0.5e-3, Teeth::ragged);
  set_thread_count(1);
  const std::vector<Vec3d> one = repaired(scene, 1);
  set_thread_count(4);
  const std::vector<Vec3d> four = repaired(scene, 1);
  set_thread_count(0);
  EXPECT_TRUE(one == four);
}

TEST(RepairKinds, EndsAtTheLimitOfItsWorkWithNoMorePairsThanBefore) {
  Scene scene;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
  scene.cloths.push_back(shaped_sheet(0.2, 300, as_it_is));
  scene.cloths.push_back(shaped_sheet(0.2, 330, [&](Vec3d p) {
    return Vec3d{p.x + 0.002, noise(random), p.z + 0.003};
  }));
  const std::vector<Vec3d> before = repaired(scene, 0);
  for (const double work : {1e-4, 1e-3, 1e-2, 1e-1}) repaired(scene, work);
  EXPECT_TRUE(before != repaired(scene, 1)) << "without a limit vertices move";

  // Without any work nothing moves.
  std::size_t next = 0;
  for (const Cloth& cloth : scene.cloths)
    for (const Vec3d& p : cloth.mesh.positions) EXPECT_TRUE(p == before[next++]);
}

TEST(RepairKinds, TakesBackTheMovesThatDoNotPay) {
  // Two places where a sheet crosses the one below it: one of them is lifted out, the other one is
  // pushed further in.
  Scene scene;
  scene.cloths = {make_sheet(lying(0.2, 500), {}), bump(700, 1e-3, 0.02, {-0.05, 0, 0}, 0.002)};
  for (Vec3d& p : scene.cloths[1].mesh.positions) {
    const double r = std::hypot(p.x - 0.05, p.z) / 0.02;
    p.y -= 1.5e-3 * std::max(0.0, 1 - r * r);
  }
  RepairMesh mesh(scene);
  const std::vector<Vec3d> before = mesh.x;
  const auto pairs = find_intersections(mesh);
  ASSERT_GT(pairs.size(), 10u);
  const auto is_left = [](Vec3d p) { return p.x < 0; };
  for (Vec3d& p : mesh.x)
    if (p.y < 0) p.y = is_left(p) ? 1e-4 : 3 * p.y;

  const auto left = keep_what_pays(mesh, {before, pairs, {}, 0.01, false});
  EXPECT_LT(left.size(), pairs.size());
  EXPECT_GT(left.size(), 0u);
  EXPECT_EQ(left.size(), find_intersections(mesh).size());
  for (std::size_t v = 0; v < before.size(); ++v)
    EXPECT_EQ(mesh.x[v] != before[v], before[v].y < 0 && is_left(before[v])) << v;

  // What went too far goes back as well, whatever it is good for.
  mesh.x = before;
  for (Vec3d& p : mesh.x)
    if (p.y < 0) p.y = 1e-4;
  EXPECT_EQ(keep_what_pays(mesh, {before, pairs, {}, 1e-5, false}).size(), pairs.size());
  EXPECT_TRUE(mesh.x == before);
}

TEST(RepairKinds, PartsThePanelsOfADeliveredDress) {
  const char* folder = std::getenv("ICLOTH_DATA");
  const std::string path =
      std::string(folder ? folder : ICLOTH_DATA_DEFAULT) + "/garments/dress_draped.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference data: " << path;
  const std::vector<std::string> overrides{"repair_start=on"};
  const auto scene = load_scene(path, overrides, {}, nullptr);
  ASSERT_TRUE(scene->repair.has_value());
  EXPECT_EQ(scene->repair->pairs_before, 426u);
  EXPECT_EQ(scene->repair->pairs_left, 0u);
  EXPECT_LT(scene->repair->largest_move, 1e-3);
  EXPECT_TRUE(find_start_intersections(*scene, true).empty());
}

}  // namespace
}  // namespace icloth
