// The contacts that the stage finds: how large they count, and which are left out.
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include "sim/collision/proximity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/index.h"
#include "tests/support/stage_support.h"

namespace icloth::cpu64 {
namespace {

/// A sheet that lies half the thickness over a box.
Scene sheet_over_box(double size, Index triangles, double thickness) {
  Scene scene;
  scene.cloths.push_back(
      testing::make_sheet(testing::lying(size, triangles), {0, 0.5 * thickness, 0}));
  scene.obstacles.push_back(
      testing::make_obstacle(make_box({0.9 * size, size, 0.8 * size}, 0.3 * size),
                             {0.001 * size, -0.5 * size, 0.002 * size}));
  scene.parameters.proximity.thickness = thickness;
  return scene;
}

std::vector<Contact> contacts_of(Stage& stage) {
  BroadPhase broad_phase;
  Proximity proximity;
  SubstepContext step = stage.context();
  broad_phase.prepare(step);
  proximity.find(step, broad_phase, let_go_view(stage.state, stage.mesh));
  return proximity.contacts().download();
}

/// Area of the smaller feature of a contact between cloth and body.
double feature_area(const World& world, const Contact& c) {
  const Pair pair = key_pair(c.key);
  if (key_is_edge_edge(c.key)) return world.edge_area[at(pair.a)];
  return pair.a < world.cloth_vertices ? world.area[at(pair.a)] : world.face_area[at(pair.b)];
}

TEST(Proximity, ContactsOfACoarseSheetHaveTheAreaOfTheirFeatures) {
  Stage stage(sheet_over_box(0.1, 200, 1e-3));
  const std::vector<Contact> contacts = contacts_of(stage);
  ASSERT_GT(contacts.size(), 50u);
  for (const Contact& c : contacts) EXPECT_EQ(c.area, feature_area(stage.world, c));
}

TEST(Proximity, ContactsOfAFineSheetHoldTheTensionOfClothThatHangsOverAnEdge) {
  Stage stage(sheet_over_box(0.005, 200, 1.5e-4));
  const double k = stage.parameters.proximity.stiffness, h = stage.parameters.proximity.thickness;
  const std::vector<Contact> contacts = contacts_of(stage);
  ASSERT_GT(contacts.size(), 50u);
  for (const Contact& c : contacts) {
    // One row of features, each as wide as the root of its area, carries 1 N for each metre.
    const double width = std::sqrt(feature_area(stage.world, c));
    EXPECT_LT(k * h * width, 0.1);
    EXPECT_NEAR(k * h * c.area / width, 1, 1e-9);
  }
}

TEST(Proximity, PairsThatAreLetGoAreLeftOutAndNoOthers) {
  Stage stage(sheet_over_box(0.1, 200, 1e-3));
  const std::vector<Contact> all = contacts_of(stage);
  const Index vertex = all[all.size() / 2].s.v[0], body = 1;
  ASSERT_LT(vertex, stage.world.cloth_vertices);
  stage.state.let_go.upload(std::vector<LetGo>{{vertex, body, 1}});

  std::vector<std::uint64_t> expected, found;
  for (const Contact& c : all)
    if (std::ranges::find(c.s.v, vertex) == std::end(c.s.v)) expected.push_back(c.key);
  for (const Contact& c : contacts_of(stage)) found.push_back(c.key);
  EXPECT_LT(expected.size(), all.size());
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace icloth::cpu64
