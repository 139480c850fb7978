#include "render/pick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/scene/shapes.h"

namespace icloth {
namespace {

/// A sheet before a ball, seen along −z.
struct Stage {
  World world;
  std::vector<Vec3f> positions;

  explicit Stage(double sheet_z) {
    Scene scene;
    GridShape shape;
    shape.triangles = 400;
    GridMesh grid = make_grid(shape);
    Cloth cloth;
    cloth.name = "sheet";
    for (Vec3d& p : grid.mesh.positions) p.z += sheet_z;
    cloth.mesh = grid.mesh;
    cloth.rest = grid.rest;
    scene.cloths.push_back(cloth);
    Obstacle ball;
    ball.name = "ball";
    ball.mesh = make_sphere(0.2, 300);
    scene.obstacles.push_back(ball);
    world = make_world(scene);
    for (const Vec3d p : world.position) positions.push_back(convert<float>(p));
  }

  Vec3d corner(Index face, std::size_t k) const {
    return convert<double>(
        positions[static_cast<std::size_t>(world.face[static_cast<std::size_t>(face)][k])]);
  }
};

constexpr Vec3d kBack{0, 0, -1};

TEST(Pick, BarycentricWeightsGiveThePoint) {
  const Stage stage(0.5);
  const Pick hit = pick(stage.world, stage.positions, {{0.123, -0.077, 3}, kBack});
  ASSERT_TRUE(hit.hit_cloth());
  EXPECT_LT(hit.face, stage.world.cloth_faces);
  EXPECT_NEAR(hit.distance, 2.5, 1e-6);
  const Vec3d sum = hit.barycentric.x * stage.corner(hit.face, 0) +
                    hit.barycentric.y * stage.corner(hit.face, 1) +
                    hit.barycentric.z * stage.corner(hit.face, 2);
  EXPECT_NEAR(norm(sum - hit.point), 0, 1e-9);
  EXPECT_NEAR(hit.point.x, 0.123, 1e-9);
  EXPECT_NEAR(hit.point.y, -0.077, 1e-9);
}

TEST(Pick, TellsWhatIsBeforeTheCloth) {
  const Stage before(0.5), behind(-0.5);
  const Ray ray{{0.01, 0.02, 3}, kBack};
  const Pick free_cloth = pick(before.world, before.positions, ray);
  EXPECT_TRUE(free_cloth.reachable());
  EXPECT_TRUE(free_cloth.hit_obstacle());
  const Pick hidden = pick(behind.world, behind.positions, ray);
  EXPECT_TRUE(hidden.hit_cloth());
  EXPECT_FALSE(hidden.reachable());
  EXPECT_GE(hidden.obstacle_face, behind.world.cloth_faces);
  EXPECT_NEAR(hidden.obstacle_point.z, 0.2, 5e-3);
}

TEST(Pick, BothSidesCountAndNothingBehindTheEye) {
  const Stage stage(0.5);
  EXPECT_TRUE(pick(stage.world, stage.positions, {{0.3, 0.3, -3}, {0, 0, 1}}).hit_cloth());
  EXPECT_FALSE(pick(stage.world, stage.positions, {{0.3, 0.3, 3}, {0, 0, 1}}).hit_cloth());
  const Pick miss = pick(stage.world, stage.positions, {{0.9, 0.9, 3}, kBack});
  EXPECT_FALSE(miss.hit_cloth());
  EXPECT_FALSE(miss.hit_obstacle());
  EXPECT_FALSE(miss.reachable());
}

TEST(Pick, NoRaySlipsBetweenFaces) {
  const Stage stage(0.5);
  for (Index v = 0; v < stage.world.cloth_vertices; ++v) {  // straight at every inner vertex
    const Vec3d p = convert<double>(stage.positions[static_cast<std::size_t>(v)]);
    if (std::fabs(p.x) > 0.49 || std::fabs(p.y) > 0.49) continue;
    EXPECT_TRUE(pick(stage.world, stage.positions, {{p.x, p.y, 3}, kBack}).hit_cloth()) << v;
  }
  std::mt19937 random(7);
  for (int k = 0; k < 500; ++k) {
    const auto number = [&] { return 0.98 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
    const double x = number(), y = number();
    EXPECT_TRUE(pick(stage.world, stage.positions, {{x, y, 3}, kBack}).hit_cloth())
        << x << " " << y;
  }
}

}  // namespace
}  // namespace icloth
