// Meshed patterns whose triangles are cut into four.
#include "sim/pattern/divide_pattern.h"

#include <gtest/gtest.h>

#include "kernels/index.h"
#include "tests/sim/pattern/pattern_support.h"

namespace icloth {
namespace {

double area_of(const PanelMesh& mesh, std::size_t face) {
  const Triangle& t = mesh.faces[face];
  const Vec2d a = mesh.points[at(t[0])], b = mesh.points[at(t[1])], c = mesh.points[at(t[2])];
  return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

/// Two squares, 3 cm apart, that are sewn along so many sides from the right one on.
Pattern squares(int sides) {
  const std::string back =
      R"("translation": [0, 0, -3], "rotation": [0, 180, 0])";  // its left side lies on the right
  std::string stitches = stitch("front", 1, "back", 3);
  if (sides > 1) stitches.append(",").append(stitch("front", 2, "back", 2));
  return parsed(
      pattern_file(rectangle("front", 40, 40) + "," + rectangle("back", 40, 40, back), stitches));
}

TEST(DividePattern, CutsEveryTriangleIntoFourOfTheSameArea) {
  const MeshedPattern coarse = mesh_pattern(parsed(pattern_file(shirt_front())), 0.03);
  const DividedPattern divided = divide_pattern(coarse);
  const PanelMesh &before = coarse.panels[0], &after = divided.meshed.panels[0];
  ASSERT_EQ(after.faces.size(), 4 * before.faces.size());
  for (std::size_t f = 0; f < after.faces.size(); ++f)
    EXPECT_NEAR(area_of(after, f), 0.25 * area_of(before, f / 4), 1e-12);
  EXPECT_EQ(divided.meshed.edge_length, 0.5 * coarse.edge_length);
}

TEST(DividePattern, KeepsTheOutlineFirstAndHalvesItsEdges) {
  const MeshedPattern coarse = mesh_pattern(parsed(pattern_file(shirt_front())), 0.03);
  const DividedPattern divided = divide_pattern(coarse);
  const PanelMesh &before = coarse.panels[0], &after = divided.meshed.panels[0];
  Index next = 0;
  for (std::size_t e = 0; e < before.edge_points.size(); ++e) {
    const std::vector<Index>&old = before.edge_points[e], &now = after.edge_points[e];
    ASSERT_EQ(now.size(), 2 * old.size() - 1);
    for (std::size_t i = 0; i < now.size(); ++i) {
      // The last edge ends where the first one begins.
      const bool closes = e + 1 == before.edge_points.size() && i + 1 == now.size();
      EXPECT_EQ(now[i], closes ? 0 : next + static_cast<Index>(i));
      const Vec2d a = before.points[at(old[i / 2])], b = before.points[at(old[(i + 1) / 2])];
      EXPECT_EQ(after.points[at(now[i])].x, 0.5 * (a.x + b.x));
      EXPECT_EQ(after.points[at(now[i])].y, 0.5 * (a.y + b.y));
    }
    next = now.back();
  }
}

TEST(DividePattern, NamesTheParentsOfEveryPoint) {
  const MeshedPattern coarse = mesh_pattern(parsed(pattern_file(shirt_front())), 0.03);
  const DividedPattern divided = divide_pattern(coarse);
  const PanelMesh &before = coarse.panels[0], &after = divided.meshed.panels[0];
  ASSERT_EQ(divided.parents[0].size(), after.points.size());
  std::size_t old = 0;
  for (std::size_t v = 0; v < after.points.size(); ++v) {
    const auto [a, b] = divided.parents[0][v];
    old += a == b;
    EXPECT_EQ(after.points[v].x, 0.5 * (before.points[at(a)].x + before.points[at(b)].x));
    EXPECT_EQ(after.points[v].y, 0.5 * (before.points[at(a)].y + before.points[at(b)].y));
  }
  EXPECT_EQ(old, before.points.size());
}

TEST(DividePattern, IsSewnAsTheCoarsePatternIs) {
  const Pattern pattern = squares(1);
  const MeshedPattern coarse = mesh_pattern(pattern, 0.04);
  const DividedPattern divided = divide_pattern(coarse);
  EXPECT_TRUE(is_sewn_alike(sew_panels(coarse, placements_of(pattern)),
                            sew_panels(divided.meshed, placements_of(pattern))));
}

TEST(DividePattern, TellsWhereCornersOfPanelsMakeOneTriangleOfTwo) {
  // In so coarse a mesh the corner between two seams is one triangle of each panel, and all three
  // of its vertices are sewn to those of the other one. Divided, they have middles of their own.
  const Pattern pattern = squares(2);
  const MeshedPattern coarse = mesh_pattern(pattern, 0.2);
  const DividedPattern divided = divide_pattern(coarse);
  EXPECT_FALSE(is_sewn_alike(sew_panels(coarse, placements_of(pattern)),
                             sew_panels(divided.meshed, placements_of(pattern))));
}

}  // namespace
}  // namespace icloth
