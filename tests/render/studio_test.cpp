// Values that the renderer works out before OpenGL: lights, thread directions, markers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/lights.h"
#include "render/material_coordinates.h"
#include "render/overlay.h"
#include "sim/scene/shapes.h"

namespace icloth {
namespace {

World sheet_world() {
  GridShape shape;
  shape.triangles = 300;
  shape.bend_radius = 0.2;
  GridMesh grid = make_grid(shape);
  Scene scene;
  Cloth cloth;
  cloth.name = "sheet";
  cloth.mesh = grid.mesh;
  cloth.rest = grid.rest;
  scene.cloths.push_back(cloth);
  return make_world(scene);
}

TEST(Lights, SamplesCoverSkyLightAndPixelEvenly) {
  constexpr int kSamples = 64;
  Vec3d dome{}, key{};
  double x = 0, y = 0;
  for (int i = 0; i < kSamples; ++i) {
    const LightSample sample = light_sample(i, kSamples);
    EXPECT_NEAR(norm(sample.dome), 1, 1e-12);
    EXPECT_NEAR(norm(sample.key), 1, 1e-12);
    EXPECT_GT(sample.dome.y, 0);
    EXPECT_LT(std::fabs(sample.pixel_x), 0.5);
    dome += (1.0 / kSamples) * sample.dome;
    key += (1.0 / kSamples) * sample.key;
    x += sample.pixel_x;
    y += sample.pixel_y;
  }
  EXPECT_NEAR(dome.x, 0, 0.02);  // the mean direction of a half-sphere is half of up
  EXPECT_NEAR(dome.y, 0.5, 1e-3);
  EXPECT_NEAR(dome.z, 0, 0.02);
  EXPECT_NEAR(norm(normalized(key) - light_sample(0, 1).key), 0, 0.01);
  EXPECT_NEAR(x, 0, 1e-12);
  EXPECT_NEAR(y, 0, 1e-12);
}

TEST(Lights, MatrixShowsTheWholeSphere) {
  const Bounds bounds{{0.3, 1.2, -0.4}, 0.7};
  for (int i = 0; i < 16; ++i) {
    const Vec3d direction = light_sample(i, 16).dome;
    const Eigen::Matrix4d m = light_matrix(bounds, direction);
    for (int k = 0; k < 16; ++k) {
      const Vec3d p = bounds.centre + bounds.radius * light_sample(k, 16).dome;
      const Eigen::Vector4d clip = m * Eigen::Vector4d(p.x, p.y, p.z, 1);
      EXPECT_EQ(clip.w(), 1);
      EXPECT_LE(clip.head<3>().cwiseAbs().maxCoeff(), 1 + 1e-9);
    }
  }
}

TEST(Lights, BoundsLeaveOutAFloorThatReachesFar) {
  std::vector<Vec3f> points{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const double alone = bounds_of(points, 3).radius;
  points.push_back({100, -1, 100});
  EXPECT_EQ(bounds_of(points, 3).radius, alone);
  points.push_back({0, -1, 0});
  EXPECT_GT(bounds_of(points, 3).radius, alone);
  EXPECT_GT(bounds_of({}, 0).radius, 0);
}

TEST(MaterialCoordinates, AreTheFlatSheetUpToAShift) {
  const World world = sheet_world();
  const auto corners = material_coordinates(world);
  ASSERT_EQ(corners.size(), static_cast<std::size_t>(world.cloth_faces));
  const auto rest = [&](std::size_t face, std::size_t k) {
    const Vec3d p = world.rest[static_cast<std::size_t>(world.face[face][k])];
    return Vec2d{p.x, p.y};
  };
  const Vec2d shift = corners[0][0] - rest(0, 0);
  for (std::size_t f = 0; f < corners.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(corners[f][k].x, rest(f, k).x + shift.x, 1e-9);
      EXPECT_NEAR(corners[f][k].y, rest(f, k).y + shift.y, 1e-9);
    }
  }
}

TEST(Overlay, KeepsItsSizeInPixels) {
  const World world = sheet_world();
  std::vector<Vec3f> positions;
  for (const Vec3d p : world.position) positions.push_back(convert<float>(p));
  const std::vector<HandleState> handles{{{.id = 1, .target = {0.1, 0, 0}}, {0, 0, 0}, 0.5}};
  Frame frame;
  frame.positions = positions;
  EXPECT_TRUE(overlay_triangles(world, frame, Camera(), 400).empty());
  frame.handles = handles;
  for (const double distance : {1.0, 10.0}) {
    const Camera camera(CameraPose{"", {0, 0, distance}, {0, 0, 0}, {0, 1, 0}, 35});
    double lowest = 0;
    const auto triangles = overlay_triangles(world, frame, camera, 400);
    EXPECT_EQ(triangles.size() % 3, 0u);
    for (const OverlayVertex& v : triangles)
      lowest = std::max(lowest, camera.project(convert<double>(v.position), 400, 400).y);
    EXPECT_NEAR(lowest, 200 + 7.2, 0.6);  // the target's ball with its rim
  }
}

}  // namespace
}  // namespace icloth
