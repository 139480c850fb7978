// The rim of a held patch, against the circle that it is at rest.
#include "app/window/patch_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/index.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::lying;
using testing::make_sheet;

/// Two sheets above each other; the upper one is rolled up later.
Scene two_sheets() {
  Scene scene;
  scene.cloths.push_back(make_sheet(lying(0.4, 5000), {0, 0.1, 0}));
  scene.cloths.push_back(make_sheet(lying(0.4, 5000), {}));
  return scene;
}

HeldHandle hand(double radius) {
  HeldHandle handle;
  handle.face = 2550;
  handle.radius = radius;
  return handle;
}

double length(const std::vector<LineSegment>& lines) {
  double sum = 0;
  for (const LineSegment& line : lines) sum += norm(line.b - line.a);
  return sum;
}

class PatchOutline : public ::testing::Test {
 protected:
  const Scene scene_ = two_sheets();
  const World world_ = make_world(scene_);
  std::vector<Vec3f> positions_ = start();

  std::vector<LineSegment> outline(const HeldHandle& handle, double share = 0) const {
    return patch_outline(world_, positions_, handle, {&share, 1});
  }

  std::vector<Vec3f> start() const {
    std::vector<Vec3f> positions;
    for (const Cloth& cloth : scene_.cloths)
      for (const Vec3d& p : cloth.mesh.positions) positions.push_back(convert<float>(p));
    return positions;
  }
};

TEST_F(PatchOutline, IsACircleOfTheRadiusAtRest) {
  const auto lines = outline(hand(0.1));
  const Vec3d centre = scene_.cloths[0].mesh.positions[at(scene_.cloths[0].mesh.faces[2550][0])];
  EXPECT_NEAR(length(lines), 2 * std::numbers::pi * 0.1, 0.01);
  for (const LineSegment& line : lines) {
    EXPECT_NEAR(norm(line.a - centre), 0.1, 1e-3);
    EXPECT_NEAR(line.a.y, 0.1, 1e-6) << "the other sheet has no part in it";
  }
}

TEST_F(PatchOutline, IsSmallerWhereThePullIsLarger) {
  // (1 − (d/r)²)² is a half at 0.541 r.
  const auto lines = outline(hand(0.1), 0.5);
  EXPECT_NEAR(length(lines), 2 * std::numbers::pi * 0.0541, 0.01);
}

TEST_F(PatchOutline, HasALineForEachShare) {
  const double both[] = {0, 0.5};
  const auto lines = patch_outline(world_, positions_, hand(0.1), both);
  EXPECT_NEAR(length(lines), length(outline(hand(0.1))) + length(outline(hand(0.1), 0.5)), 1e-9);
}

TEST_F(PatchOutline, FollowsTheFoldsOfTheCloth) {
  // Rolled round an axis along z, the rim is as long as before and nowhere flat.
  const double flat = length(outline(hand(0.1)));
  for (Vec3f& p : positions_) p = {0.1f * std::sin(p.x / 0.1f), 0.1f * std::cos(p.x / 0.1f), p.z};
  const auto lines = outline(hand(0.1));
  EXPECT_NEAR(length(lines), flat, 0.01 * flat);
  double low = 1, high = -1;
  for (const LineSegment& line : lines) {
    low = std::min(low, line.a.y);
    high = std::max(high, line.a.y);
  }
  EXPECT_GT(high - low, 0.03);
}

TEST_F(PatchOutline, IsEmptyWhereThereIsNothingToDraw) {
  EXPECT_TRUE(outline(hand(0)).empty());
  EXPECT_TRUE(outline(hand(2)).empty()) << "all of the cloth is held";
  HeldHandle none = hand(0.1);
  none.face = world_.cloth_faces;
  EXPECT_TRUE(outline(none).empty());
}

}  // namespace
}  // namespace icloth
