// What is drawn over cloth and bodies.
#include "render/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace icloth {
namespace {

TEST(Overlay, StitchesAreLinesUntilTheyAreShutAndRedderTheWiderTheyAre) {
  const std::vector<Vec3f> positions = {{0, 0, 0}, {0, 0.1f, 0}, {0, 0.005f, 0}, {0, 0.0001f, 0}};
  const World world;
  Frame frame;
  frame.positions = positions;
  const auto drawn = [&](Index end) {
    const std::array<Index, 2> pair{0, end};
    frame.stitches = {&pair, 1};
    return overlay_triangles(world, frame, Camera(), 600);
  };
  const auto wide = drawn(1), narrow = drawn(2), shut = drawn(3);
  ASSERT_EQ(wide.size(), 6u);
  ASSERT_EQ(narrow.size(), 6u);
  EXPECT_EQ(shut.size(), 0u);
  EXPECT_GT(wide[0].colour[0], narrow[0].colour[0]);
  EXPECT_LT(wide[0].colour[1], narrow[0].colour[1]);
}

TEST(Overlay, PinsAndOutlinesAreLiftedTowardsTheEye) {
  const World world;
  const Camera camera;
  const Vec3d pin{0, 0.1, 0};
  const LineSegment line{{0, 0, 0}, {0.1, 0.1, 0}};
  for (const bool is_pin : {true, false}) {
    Frame frame;
    frame.pins = {&pin, is_pin ? 1u : 0u};
    frame.outlines = {&line, is_pin ? 0u : 1u};
    const auto drawn = overlay_triangles(world, frame, camera, 600);
    ASSERT_FALSE(drawn.empty());

    // Nothing is drawn behind the point that it stands for, where the cloth would hide it.
    for (const OverlayVertex& v : drawn) {
      const Vec3d p = convert<double>(v.position);
      const Vec3d a = is_pin ? pin : line.a, b = is_pin ? pin : line.b;
      const Vec3d nearest = norm(p - a) < norm(p - b) ? a : b;
      EXPECT_GT(dot(p - nearest, camera.eye() - nearest), 0);
    }
  }
}

TEST(Overlay, AHandHasAPlumbLineThatEndsInALevelSpot) {
  const World world;
  Frame frame;
  const DropLine drop{{0.1, 0.8, 0}, {0.1, 0.2, 0}};
  EXPECT_TRUE(overlay_triangles(world, frame, Camera(), 600).empty());
  frame.drop_lines = {&drop, 1};
  const auto drawn = overlay_triangles(world, frame, Camera(), 600);
  ASSERT_FALSE(drawn.empty());
  float low = 1, high = 0, wide = 0;
  for (const OverlayVertex& v : drawn) {
    low = std::min(low, v.position.y);
    high = std::max(high, v.position.y);
    wide = std::max(wide, std::abs(v.position.z));
  }
  EXPECT_NEAR(high, 0.8, 1e-3);
  EXPECT_NEAR(low, 0.2, 0.02);
  EXPECT_GT(wide, 0) << "the spot lies flat";
}

}  // namespace
}  // namespace icloth
