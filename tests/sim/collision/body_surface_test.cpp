// The surface of a body against what a sphere's and a box's formulas say.
#include "sim/collision/body_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

World world_of(TriangleMesh body) {
  Scene scene;
  scene.cloths.push_back(testing::make_sheet(testing::lying(0.1, 8), {5, 5, 5}));
  scene.obstacles.push_back(testing::make_obstacle(std::move(body), {}));
  return make_world(scene);
}

/// Signed distance to a box around the origin of the given half size.
double box_distance(Vec3d p, double half) {
  const Vec3d q{std::fabs(p.x) - half, std::fabs(p.y) - half, std::fabs(p.z) - half};
  const Vec3d out{std::fmax(q.x, 0), std::fmax(q.y, 0), std::fmax(q.z, 0)};
  return norm(out) + std::fmin(std::fmax(q.x, std::fmax(q.y, q.z)), 0);
}

TEST(BodySurface, MeasuresTheDistanceToABoxWithItsSign) {
  TriangleMesh mesh = make_box({0.2, 0.2, 0.2}, 0.07);
  for (const bool turned : {false, true}) {
    if (turned)
      for (Triangle& t : mesh.faces) std::swap(t[0], t[1]);
    const World world = world_of(mesh);
    const BodySurface surface(world, 1);
    EXPECT_EQ(surface.own_side(), turned ? -1 : 1);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-0.2, 0.2);
    for (int k = 0; k < 300; ++k) {
      const Vec3d p{uniform(random), uniform(random), uniform(random)};
      const SurfacePoint q = surface.nearest(world.position, p, surface.own_side());
      const double expected = box_distance(p, 0.1);
      ASSERT_NEAR(q.distance, expected, 1e-9);
      // A step along the normal goes outwards by its length.
      ASSERT_NEAR(norm(q.normal), 1, 1e-9);
      ASSERT_GT(box_distance(p + 1e-4 * q.normal, 0.1), expected);
    }
  }
}

TEST(BodySurface, AnOpenSurfaceIsToldItsSide) {
  const World world = world_of(make_plane(1, 1, 0.2));
  const BodySurface surface(world, 1);
  EXPECT_EQ(surface.own_side(), 0);
  const Vec3d above{0.1, 0.03, 0.2};
  EXPECT_NEAR(surface.nearest(world.position, above, 1).distance, 0.03, 1e-12);
  EXPECT_NEAR(surface.nearest(world.position, above, -1).distance, -0.03, 1e-12);
}

TEST(BodySurface, FindsWhatATriangleTouches) {
  const World world = world_of(make_box({0.2, 0.2, 0.2}, 0.2));
  const BodySurface surface(world, 1);
  // A corner of the box goes through the second triangle; the others stay outside and inside.
  const std::array<Vec3d, 3> apart{{{0.3, 0, 0}, {0.4, 0, 0}, {0.3, 0.1, 0}}};
  const std::array<Vec3d, 3> cut{{{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}}};
  const std::array<Vec3d, 3> within{{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}}};
  EXPECT_FALSE(surface.touches(world.position, apart));
  EXPECT_TRUE(surface.touches(world.position, cut));
  EXPECT_FALSE(surface.touches(world.position, within));
  EXPECT_TRUE(surface.crossings(world.position, apart, 1).empty());
  const auto found = surface.crossings(world.position, cut, 1);
  ASSERT_FALSE(found.empty());
  for (const SurfaceCrossing& c : found) {
    const Vec3d p = c.w[0] * cut[0] + c.w[1] * cut[1] + c.w[2] * cut[2];
    EXPECT_NEAR(box_distance(p, 0.1), 0, 1e-9);
    EXPECT_GT(dot(c.normal, p), 0);
  }
}

}  // namespace
}  // namespace icloth
