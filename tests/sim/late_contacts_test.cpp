// Many impacts of a candidate join the contacts before the impact zones get them.
#include <gtest/gtest.h>

#include "tests/support/intersections.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::count_intersections;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;

/// Two sheets that fall onto a ball so fast that they reach it, and each other, within a step.
std::shared_ptr<Scene> falling_sheets(int rounds) {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->cloths.push_back(make_sheet(lying(0.4, 1500), {0.01, 0.14, 0.02}));
  scene->cloths.push_back(make_sheet(lying(0.4, 1500), {0, 0.16, 0}));
  scene->obstacles.push_back(make_obstacle(make_sphere(0.1, 1280), {}));
  scene->parameters.wind.air_density = 0;
  scene->parameters.proximity.late_rounds = rounds;
  return scene;
}

/// Impacts that are left to the zones in three steps. The second one reaches the ball; without late
/// contacts it has to be cut.
std::int64_t impacts_of_the_fall(int rounds) {
  const auto scene = falling_sheets(rounds);
  const auto simulator = make_simulator(Build::cpu64, scene);
  Snapshot state = simulator->snapshot();
  const std::size_t cloth = 2 * scene->cloths[0].mesh.positions.size();
  for (std::size_t i = 0; i < cloth; ++i) state.v[i].y = -4;
  simulator->restore(state);

  std::int64_t sum = 0, late = 0;
  for (int k = 0; k < 3; ++k) {
    const StepReport report = simulator->step({});
    EXPECT_TRUE(report.accepted);
    EXPECT_TRUE(report.substeps == 1 || rounds == 0);
    EXPECT_EQ(count_intersections(*simulator), 0u);
    sum += report.impacts_first;
    late += report.late_contacts;
  }
  EXPECT_EQ(late > 0, rounds > 0);
  return sum;
}

/// A sheet that is held on two sides, while a ball stretches it beyond the strain where the fabric
/// hardens.
std::shared_ptr<Scene> taut_sheet() {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  const GridShape shape = lying(0.3, 1800);
  Cloth sheet = make_sheet(shape, {});
  sheet.material.strain_limit = 0.05;
  for (const char* side : {"left", "right"})
    for (const Index v : grid_vertices(make_grid(shape), side)) sheet.pins.push_back(v);
  scene->cloths.push_back(std::move(sheet));
  scene->obstacles.push_back(make_obstacle(make_sphere(0.05, 1280), {0, -0.053, 0}));
  scene->obstacles[0].motion = {{0, {}, {}}, {0.3, {0, 0.09, 0}, {}}, {1, {0, 0.09, 0}, {}}};
  return scene;
}

TEST(LateContacts, CarryTautClothThatTheZonesWouldTear) {
  const auto scene = taut_sheet();
  const auto simulator = make_simulator(Build::cpu64, scene);
  double strain = 0;
  std::int64_t late = 0, left = 0;
  for (int k = 0; k < 80; ++k) {
    const StepReport report = simulator->step({});
    ASSERT_TRUE(report.accepted);
    strain = std::max(strain, report.max_strain);
    late += report.late_contacts;
    left += report.impacts_first;
  }
  EXPECT_GT(late, 1000);
  EXPECT_LT(left, late / 10);
  EXPECT_LT(strain, 0.25);
}

TEST(LateContacts, LeaveFewImpactsOfFastClothToTheZones) {
  const std::int64_t without = impacts_of_the_fall(0), with = impacts_of_the_fall(1);
  EXPECT_GT(without, 50);
  EXPECT_LT(with, without / 5);
}

}  // namespace
}  // namespace icloth
