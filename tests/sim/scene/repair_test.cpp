// Start states that intersect a little are separated, and can be simulated then.
#include "sim/scene/repair.h"

#include <gtest/gtest.h>

#include "sim/scene/intersections.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;

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

}  // namespace
}  // namespace icloth
