// Panels in space, and what becomes one when they are sewn.
#include "sim/pattern/sewing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>

#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/pattern/outline.h"
#include "tests/sim/pattern/pattern_support.h"

namespace icloth {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

bool has_note(const SewnGarment& garment, const std::vector<std::string>& words) {
  return std::ranges::any_of(garment.notes, [&](const std::string& note) {
    return std::ranges::all_of(
        words, [&](const std::string& word) { return note.find(word) != std::string::npos; });
  });
}

void expect_near(Vec3d a, Vec3d b, double tolerance) { EXPECT_LT(norm(a - b), tolerance); }

/// Area of a face in material coordinates, above 0 where it turns counter-clockwise.
double uv_area(const std::array<Vec2d, 3>& uv) {
  const Vec2d a = uv[1] - uv[0], b = uv[2] - uv[0];
  return 0.5 * (a.x * b.y - a.y * b.x);
}

/// Faces at every edge.
std::map<std::pair<Index, Index>, int> edges_of(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const Triangle& t : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  return edges;
}

/// Vertices less edges plus faces, and the number of edges with one face.
std::pair<std::ptrdiff_t, std::ptrdiff_t> euler_and_border(const TriangleMesh& mesh) {
  const auto edges = edges_of(mesh);
  std::ptrdiff_t border = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_LE(count, 2);
    border += count == 1;
  }
  return {std::ssize(mesh.positions) - std::ssize(edges) + std::ssize(mesh.faces), border};
}

/// A front and a back of 40 × 60 cm, 30 cm apart, sewn along both sides.
std::string sack(const std::string& third = "") {
  return pattern_file(
      rectangle("front", 40, 60, R"("translation": [-20, 100, 15])") + "," +
          rectangle("back", 40, 60, R"("translation": [20, 100, -15], "rotation": [0, 180, 0])"),
      stitch("front", 1, "back", 3, third) + "," + stitch("front", 3, "back", 1));
}

TEST(Placement, TurnsAboutXThenYThenZ) {
  const std::vector<Vec2d> points{{1, 0}, {0, 1}};
  const auto placed = place_points(points, {{1, 2, 3}, {90, 90, 0}, 0});
  expect_near(placed[0], Vec3d{1, 2, 3} + Vec3d{0, 0, -1}, 1e-15);
  expect_near(placed[1], Vec3d{1, 2, 3} + Vec3d{1, 0, 0}, 1e-15);
  const auto third = place_points(points, {{}, {0, 0, 30}, 0});
  expect_near(third[0], {std::sqrt(0.75), 0.5, 0}, 1e-15);
}

TEST(Placement, RightAnglesAreExact) {
  const std::vector<Vec2d> points{{0.3, 0.7}};
  for (const double turn : {180.0, -180.0, 540.0}) {
    const Vec3d x = place_points(points, {{}, {0, turn, 0}, 0})[0];
    EXPECT_EQ(x.x, -0.3);
    EXPECT_EQ(x.y, 0.7);
    EXPECT_EQ(x.z, 0);
  }
  EXPECT_EQ(place_points(points, {{}, {0, 0, -90}, 0})[0].x, 0.7);
}

TEST(Placement, BendsKeepLengthsAndGoBackwards) {
  constexpr double kRadius = 0.2;
  std::vector<Vec2d> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({0.25 * i / 1000, 0});
  const auto placed = place_points(points, {{}, {}, kRadius});
  double length = 0;
  for (std::size_t i = 1; i < placed.size(); ++i) length += norm(placed[i] - placed[i - 1]);
  EXPECT_NEAR(length, 0.25, 1e-6);
  EXPECT_NEAR(placed.back().z, -kRadius * (1 - std::cos(1.25)), 1e-15);
  EXPECT_NEAR(place_points(points, {{}, {}, -kRadius}).back().z, kRadius * (1 - std::cos(1.25)),
              1e-15);
}

TEST(Sewing, TwoPanelsBecomeOneTube) {
  const SewnGarment garment = sew_pattern(parsed(sack()), 0.05);
  EXPECT_TRUE(garment.notes.empty()) << garment.notes[0];

  // A tube has Euler number 0, and borders above and below of 16 edges each.
  const auto [euler, border] = euler_and_border(garment.mesh);
  EXPECT_EQ(euler, 0);
  EXPECT_EQ(border, 32);

  // 13 points of each side are one with those of the other panel, at the middle.
  ASSERT_EQ(garment.seams.size(), 2u);
  for (const SewnSeam& seam : garment.seams) {
    EXPECT_EQ(seam.points.size(), 13u);
    EXPECT_NEAR(seam.mean_gap, 0.3, 1e-9);
    EXPECT_NEAR(seam.largest_gap, 0.3, 1e-9);
    EXPECT_NEAR(seam.length_a, 0.6, 1e-12);
    for (const auto& [a, b] : seam.points) {
      EXPECT_EQ(garment.merged[at(a)], garment.merged[at(b)]);
      expect_near(garment.mesh.positions[at(garment.merged[at(a)])],
                  0.5 * (garment.open_positions[at(a)] + garment.open_positions[at(b)]), 1e-15);
      EXPECT_NEAR(garment.mesh.positions[at(garment.merged[at(a)])].z, 0, 1e-7);
    }
  }
  EXPECT_EQ(garment.mesh.positions.size(), garment.open_positions.size() - 26);
}

TEST(Sewing, RightSidesAreOutside) {
  for (const bool clockwise : {false, true}) {
    SCOPED_TRACE(clockwise);
    // The back is turned by 180°, or drawn in the other direction.
    const std::string back =
        clockwise ? R"("back": {"vertices": [[0, 0], [40, 0], [40, 60], [0, 60]], "edges": [
              {"endpoints": [0, 3]}, {"endpoints": [3, 2]}, {"endpoints": [2, 1]},
              {"endpoints": [1, 0]}], "translation": [-20, 100, -15]})"
                  : rectangle("back", 40, 60,
                              R"("translation": [20, 100, -15], "rotation": [0, 180, 0])");
    const std::string stitches =
        clockwise ? stitch("front", 1, "back", 2) + "," + stitch("front", 3, "back", 0)
                  : stitch("front", 1, "back", 3) + "," + stitch("front", 3, "back", 1);
    const SewnGarment garment = sew_pattern(
        parsed(pattern_file(
            rectangle("front", 40, 60, R"("translation": [-20, 100, 15])") + "," + back, stitches)),
        0.05);
    EXPECT_TRUE(garment.notes.empty()) << garment.notes[0];
    const auto [euler, border] = euler_and_border(garment.mesh);
    EXPECT_EQ(euler, 0);
    EXPECT_EQ(border, 32);

    for (std::size_t f = 0; f < garment.mesh.faces.size(); ++f) {
      const Triangle& t = garment.mesh.faces[f];
      const auto& x = garment.mesh.positions;
      const Vec3d normal = cross(x[at(t[1])] - x[at(t[0])], x[at(t[2])] - x[at(t[0])]);
      const bool front = garment.panel_names[at(garment.panel[f])] == "front";
      EXPECT_GT(front ? normal.z : -normal.z, 0);
      EXPECT_GT(uv_area(garment.mesh.uv[f]), 0);
    }
  }
}

TEST(Sewing, MaterialCoordinatesAreTheFlatPanels) {
  const Pattern pattern = parsed(sack());
  const SewnGarment garment = sew_pattern(pattern, 0.05);
  std::array<double, 2> area{}, low{1e9, 1e9}, high{-1e9, -1e9};
  for (std::size_t f = 0; f < garment.mesh.faces.size(); ++f) {
    const std::size_t p = at(garment.panel[f]);
    area[p] += uv_area(garment.mesh.uv[f]);
    for (const Vec2d& c : garment.mesh.uv[f]) {
      low[p] = std::min(low[p], c.x);
      high[p] = std::max(high[p], c.x);
    }
  }
  EXPECT_NEAR(area[0], 0.24, 1e-6);
  EXPECT_NEAR(area[1], 0.24, 1e-6);
  EXPECT_NEAR(high[0] - low[0], 0.4, 1e-6);
  EXPECT_GT(low[1], high[0]);
}

TEST(Sewing, GathersHaveTheSameNumberOfPointsOnBothSides) {
  const Pattern pattern =
      parsed(pattern_file(rectangle("band", 40, 6, R"("translation": [0, 60, 0])") + "," +
                              rectangle("skirt", 80, 50, R"("translation": [-20, 0, 0])"),
                          stitch("band", 0, "skirt", 2)));
  const MeshedPattern meshed = mesh_pattern(pattern, 0.02);
  EXPECT_EQ(meshed.panels[0].edge_points[0].size(), 41u);
  EXPECT_EQ(meshed.panels[1].edge_points[2].size(), 41u);
  const SewnGarment garment = sew_panels(meshed, placements_of(pattern));
  EXPECT_NEAR(garment.seams[0].length_b / garment.seams[0].length_a, 2, 1e-12);

  // The lengths of the seam's edges differ in the flat panels by the same ratio.
  const auto& band = meshed.panels[0];
  const auto& skirt = meshed.panels[1];
  for (std::size_t i = 0; i < 40; ++i) {
    const auto length = [](const PanelMesh& mesh, const std::vector<Index>& points, std::size_t k) {
      const Vec2d d = mesh.points[at(points[k + 1])] - mesh.points[at(points[k])];
      return std::hypot(d.x, d.y);
    };
    EXPECT_NEAR(length(band, band.edge_points[0], i), 0.01, 3e-7);
    EXPECT_NEAR(length(skirt, skirt.edge_points[2], i), 0.02, 3e-7);
  }
}

TEST(Sewing, CornersOfSeveralPanelsBecomeOneVertex) {
  // Four squares around a point.
  const SewnGarment garment = sew_pattern(
      parsed(pattern_file(rectangle("a", 20, 20, R"("translation": [1, 1, 0])") + "," +
                              rectangle("b", 20, 20, R"("translation": [-21, 1, 0])") + "," +
                              rectangle("c", 20, 20, R"("translation": [-21, -21, 0])") + "," +
                              rectangle("d", 20, 20, R"("translation": [1, -21, 0])"),
                          stitch("a", 3, "b", 1) + "," + stitch("b", 0, "c", 2) + "," +
                              stitch("c", 1, "d", 3) + "," + stitch("d", 2, "a", 0))),
      0.04);
  const auto middle =
      std::ranges::find_if(garment.mesh.positions, [](Vec3d x) { return norm(x) < 1e-6; });
  ASSERT_NE(middle, garment.mesh.positions.end());
  const auto vertex = static_cast<Index>(middle - garment.mesh.positions.begin());
  EXPECT_EQ(std::ranges::count(garment.merged, vertex), 4);
  const auto [euler, border] = euler_and_border(garment.mesh);
  EXPECT_EQ(euler, 1);
  EXPECT_EQ(border, 40);
}

TEST(Sewing, FlippedStitchesAreReportedAsTwisted) {
  const SewnGarment flipped = sew_pattern(parsed(sack("right_wrong")), 0.05);
  EXPECT_TRUE(has_note(flipped, {"stitch 0 (front:1 – back:3)", "twisted", "30 cm"}));
  EXPECT_FALSE(has_note(flipped, {"stitch 1"}));
  EXPECT_FALSE(has_note(sew_pattern(parsed(sack()), 0.05), {"twisted"}));
}

TEST(Sewing, OnePanelIsTwistedWhereItsRightSideIsSewnToItsWrongSide) {
  const std::string panel = rectangle("p", 40, 60);
  EXPECT_TRUE(sew_pattern(parsed(pattern_file(panel, stitch("p", 1, "p", 3))), 0.05).notes.empty());
  EXPECT_TRUE(has_note(
      sew_pattern(parsed(pattern_file(panel, stitch("p", 1, "p", 3, "right_wrong"))), 0.05),
      {"stitch 0 (p:1 – p:3)", "twisted", "wrong side"}));
}

TEST(Sewing, MostFlippedStitchesOfThePublicPatternsAreReported) {
  const std::vector<std::string> files = data_patterns();
  if (files.empty()) GTEST_SKIP() << "no patterns in " << ICLOTH_DATA_DEFAULT;
  std::size_t reported = 0, all = 0;
  for (const std::string& file : files) {
    const Pattern pattern = read_pattern(file);
    for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
      Pattern flipped = pattern;
      flipped.stitches[s].right_wrong = true;
      const SewnGarment garment = sew_pattern(flipped, 0.05);
      ++all;
      reported += has_note(garment, {stitch_name(pattern, s), "twisted"});
    }
  }
  // Sleeves that stand at right angles to their armholes, and edges of 1 cm, leave it open.
  EXPECT_GE(reported, all * 3 / 4);
}

TEST(Sewing, TrianglesOfMergedCornersAreLeftOutAndCounted) {
  // A panel of one segment a side, folded so that two neighbouring points of a side meet.
  const std::string panel = R"("t": {"vertices": [[0, 0], [40, 0], [40, 1], [0, 1]], "edges": [
      {"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]})";
  const SewnGarment garment = sew_pattern(parsed(pattern_file(panel, stitch("t", 0, "t", 2))), 0.1);
  EXPECT_TRUE(has_note(garment, {"triangles", "left out"})) << garment.notes.size();
  for (const Triangle& t : garment.mesh.faces) {
    EXPECT_NE(t[0], t[1]);
    EXPECT_NE(t[1], t[2]);
    EXPECT_NE(t[2], t[0]);
  }
}

TEST(Sewing, LabelledEdgesAreThoseOfTheSewnMesh) {
  const std::string front =
      R"("front": {"vertices": [[0, 0], [40, 0], [40, 60], [0, 60]], "edges": [
      {"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3], "label": "collar"},
      {"endpoints": [3, 0]}], "translation": [-20, 100, 15]})";
  const SewnGarment garment = sew_pattern(
      parsed(pattern_file(front + "," + rectangle("back", 40, 60), stitch("front", 1, "back", 3))),
      0.05);
  ASSERT_EQ(garment.labelled.size(), 1u);
  EXPECT_EQ(garment.labelled[0].label, "collar");
  EXPECT_EQ(garment.labelled[0].edge, 2);
  EXPECT_EQ(garment.labelled[0].vertices.size(), 9u);
  for (std::size_t i = 1; i < 9; ++i)
    EXPECT_NEAR(garment.mesh.positions[at(garment.labelled[0].vertices[i])].y, 1.6, 1e-6);
}

TEST(Sewing, OtherPlacementsNeedNoOtherMesh) {
  const Pattern pattern = parsed(sack());
  const MeshedPattern meshed = mesh_pattern(pattern, 0.05);
  std::vector<PanelPlacement> placements = placements_of(pattern);
  for (PanelPlacement& placement : placements) placement.translation.z *= 2;
  const SewnGarment near = sew_panels(meshed, placements_of(pattern));
  const SewnGarment far = sew_panels(meshed, placements);
  EXPECT_EQ(near.mesh.faces, far.mesh.faces);
  EXPECT_NEAR(far.seams[0].mean_gap, 0.6, 1e-9);
}

TEST(Sewing, ShortEdgesStayInOnePieceAndAreNoted) {
  const std::string panel =
      R"("p": {"vertices": [[0, 0], [40, 0], [40, 40], [39.7, 40.1], [0, 40.1]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
      {"endpoints": [3, 4]}, {"endpoints": [4, 0]}]})";
  const Pattern pattern =
      parsed(pattern_file(panel + "," + rectangle("q", 0.3, 40, R"("translation": [60, 0, 0])"),
                          stitch("p", 2, "q", 0)));
  const MeshedPattern meshed = mesh_pattern(pattern, 0.02);
  EXPECT_EQ(meshed.panels[0].edge_points[2].size(), 2u);
  const SewnGarment garment = sew_pattern(pattern, 0.02);
  EXPECT_TRUE(has_note(garment, {"panel 'p'", "edge 2", "0.316 cm", "2 cm"}));
  EXPECT_EQ(mesh_pattern(pattern, 0.01).panels[0].edge_points[2].size(), 3u);  // two segments
}

TEST(Sewing, TheNumberOfTrianglesIsAboutThatAskedFor) {
  const Pattern pattern = parsed(sack());
  for (const Index wanted : {500, 5000, 50000}) {
    const SewnGarment garment = sew_pattern(pattern, edge_length_for(pattern, wanted));
    EXPECT_NEAR(static_cast<double>(garment.mesh.faces.size()), wanted, 0.1 * wanted);
  }
}

TEST(Sewing, TheNumberOfTrianglesIsCorrectedByWhatCameOut) {
  for (const char* name : {"tiered", "andy_trousers", "andy_shirt", "bishop_skirt", "flounce"}) {
    const std::string file = "garments/" + std::string(name) + "_specification.json";
    const Pattern pattern = read_pattern(find_asset(file, ""));
    for (const Index wanted : {5000, 9000}) {
      const MeshedPattern estimated = mesh_pattern(pattern, edge_length_for(pattern, wanted));
      const double before = std::fabs(triangle_count(estimated) - wanted);
      const double after = std::fabs(triangle_count(mesh_with_count(pattern, wanted)) - wanted);
      EXPECT_LE(after, std::min(before, 0.015 * wanted)) << name << ", " << wanted;
    }
  }
}

TEST(Sewing, APatternThatCannotBeMeshedCoarserKeepsItsFinerMesh) {
  // The outline needs about as many triangles as it has edges, whatever is asked for.
  const Pattern pattern = read_pattern(find_asset("garments/tiered_specification.json", ""));
  const Index estimated = triangle_count(mesh_pattern(pattern, edge_length_for(pattern, 10)));
  const Index found = triangle_count(mesh_with_count(pattern, 10));
  EXPECT_GT(found, 10);
  EXPECT_LE(found, estimated);
}

TEST(Sewing, EdgeLengthsOutOfRangeAreRefused) {
  const Pattern pattern = parsed(sack());
  for (const double h : {0.0, -1.0, 2.0, 0.0002, std::nan("")})
    EXPECT_THROW(mesh_pattern(pattern, h), InputError) << h;
}

TEST(Sewing, TwiceGivesTheSameBits) {
  const Pattern pattern = parsed(sack());
  const SewnGarment a = sew_pattern(pattern, 0.013), b = sew_pattern(pattern, 0.013);
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
  EXPECT_EQ(std::memcmp(a.mesh.positions.data(), b.mesh.positions.data(),
                        a.mesh.positions.size() * sizeof(Vec3d)),
            0);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
}

TEST(Sewing, PublicPatternsAreSewn) {
  const std::vector<std::string> files = data_patterns();
  if (files.empty()) GTEST_SKIP() << "no patterns in " << ICLOTH_DATA_DEFAULT;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Pattern pattern = read_pattern(file);
    const MeshedPattern meshed = mesh_pattern(pattern, 0.02);
    const SewnGarment garment = sew_panels(meshed, placements_of(pattern));
    EXPECT_FALSE(has_note(garment, {"left out"}));
    EXPECT_FALSE(has_note(garment, {"more than two faces"}));
    EXPECT_FALSE(has_note(garment, {"twisted"}));
    euler_and_border(garment.mesh);

    // The area is that of the pattern, but for chords of curves.
    double area = 0, wanted = 0;
    for (const auto& uv : garment.mesh.uv) {
      EXPECT_GT(uv_area(uv), 0);
      area += uv_area(uv);
    }
    for (const Panel& panel : pattern.panels) wanted += std::fabs(signed_area(panel));
    EXPECT_NEAR(area, wanted, 2e-3 * wanted);
    for (const SewnSeam& seam : garment.seams) {
      EXPECT_EQ(seam.points.size(),
                meshed.panels[at(seam.panel_a)].edge_points[at(seam.edge_a)].size());
      EXPECT_EQ(seam.points.size(),
                meshed.panels[at(seam.panel_b)].edge_points[at(seam.edge_b)].size());
    }
  }
}

}  // namespace
}  // namespace icloth
