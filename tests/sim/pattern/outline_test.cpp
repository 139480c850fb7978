// Lengths, areas and even points of curved panel edges.
#include "sim/pattern/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/sim/pattern/pattern_support.h"

namespace icloth {
namespace {

constexpr double kPi = std::numbers::pi;

double distance(Vec2d a, Vec2d b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// One panel that consists of an edge with the curvature from (10, 0) to (0, 0) and of straight
/// edges below it that spread to a width of 50, in centimetres. Its area is 600 cm² with a straight
/// edge.
Panel panel_with(const std::string& curvature) {
  return parsed(pattern_file(R"("p": {"vertices": [[10, 0], [0, 0], [-20, -20], [30, -20]],
      "edges": [{"endpoints": [0, 1], )" +
                             curvature + R"(}, {"endpoints": [1, 2]},
      {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})"))
      .panels[0];
}

/// Length up to a point of a fine polygon through the edge.
double length_to(const EdgePath& path, double share) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    sum += distance(path.at(share * i / kSteps), path.at(share * (i + 1) / kSteps));
  return sum;
}

TEST(Outline, PointsAreEvenlySpacedInArcLength) {
  for (const char* curvature :
       {R"("curvature": [0.2, 0.5])",
        R"("curvature": {"type": "quadratic", "params": [[0.9, -0.4]]})",
        R"("curvature": {"type": "cubic", "params": [[0.1, 0.6], [0.9, -0.6]]})",
        R"("curvature": {"type": "circle", "params": [7, 0, 1]})",
        R"("curvature": {"type": "circle", "params": [6, 1, 0]})", R"("label": "straight")"}) {
    SCOPED_TRACE(curvature);
    const Panel panel = panel_with(curvature);
    const EdgePath path(panel, panel.edges[0]);
    EXPECT_NEAR(length_to(path, 1), path.length(), 1e-7 * path.length());
    for (const double share : {0.125, 0.3, 0.5, 0.77})
      EXPECT_NEAR(length_to(path, share), share * path.length(), 1e-7 * path.length());
  }
}

TEST(Outline, AQuadraticCurveFollowsItsBezierForm) {
  // The control point of [0.5, 1] on the edge from (10, 0) to (0, 0) is at (5, −10).
  const Panel panel = panel_with(R"("curvature": [0.5, 1])");
  EXPECT_NEAR(panel.edges[0].control[0].x, 0.05, 1e-15);
  EXPECT_NEAR(panel.edges[0].control[0].y, -0.1, 1e-15);
  const Vec2d middle = EdgePath(panel, panel.edges[0]).at(0.5);
  EXPECT_NEAR(middle.x, 0.05, 1e-12);
  EXPECT_NEAR(middle.y, -0.05, 1e-12);
}

TEST(Outline, ArcsBulgeToTheRightWhenTheyTurnCounterClockwise) {
  const auto middle = [](const char* params) {
    const Panel panel =
        panel_with(std::string(R"("curvature": {"type": "circle", "params": )") + params + "}");
    return EdgePath(panel, panel.edges[0]).at(0.5);
  };
  // The edge runs to the left, so its right is above. Sagittae of radius 6 over a chord of 10.
  const double height = std::sqrt(36.0 - 25.0);
  EXPECT_NEAR(middle("[6, 0, 1]").y, (6 - height) / 100, 1e-12);
  EXPECT_NEAR(middle("[6, 1, 1]").y, (6 + height) / 100, 1e-12);
  EXPECT_NEAR(middle("[6, 0, 0]").y, -(6 - height) / 100, 1e-12);
  EXPECT_NEAR(middle("[6, true, false]").y, -(6 + height) / 100, 1e-12);
}

TEST(Outline, AreasOfDiscsAndSegmentsAreExact) {
  const Panel whole = parsed(pattern_file(disc("d", 12))).panels[0];
  EXPECT_NEAR(signed_area(whole), kPi * 0.12 * 0.12, 1e-15);
  EXPECT_NEAR(perimeter(whole), 2 * kPi * 0.12, 1e-15);

  // The panel with a half circle on top of it, and with one cut out.
  const char* half = R"("curvature": {"type": "circle", "params": [5, 0, 1]})";
  EXPECT_NEAR(signed_area(panel_with(half)), 0.06 + kPi * 0.05 * 0.05 / 2, 1e-15);
  const char* cut = R"("curvature": {"type": "circle", "params": [5, 0, 0]})";
  EXPECT_NEAR(signed_area(panel_with(cut)), 0.06 - kPi * 0.05 * 0.05 / 2, 1e-15);
}

TEST(Outline, AreasOfBezierCurvesAreThoseOfAFinePolygon) {
  const Panel panel =
      panel_with(R"("curvature": {"type": "cubic", "params": [[0.1, 0.5], [0.7, -0.8]]})");
  const std::vector<Vec2d> ring = outline_polygon(panel, 4000);
  double area = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2d a = ring[i], b = ring[(i + 1) % ring.size()];
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  EXPECT_NEAR(signed_area(panel), area, 1e-9);
}

TEST(Outline, GridPointsBecomeTheSameLengthsAgain) {
  for (const double x : {0.0, 0.1, -0.02, 7.3, -49.9}) {
    const Vec2d once = from_grid(to_grid({x, -x}));
    EXPECT_NEAR(once.x, x, kPanelGrid / 2);
    EXPECT_EQ(from_grid(to_grid(once)).x, once.x);
    EXPECT_EQ(once.y, -once.x);
  }
}

}  // namespace
}  // namespace icloth
