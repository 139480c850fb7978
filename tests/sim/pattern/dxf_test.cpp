// Pattern pieces from DXF files as garment programs write them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/files/error.h"
#include "sim/pattern/dxf_pieces.h"
#include "sim/pattern/outline.h"
#include "sim/pattern/sewing.h"

namespace icloth {
namespace {

/// Groups in a line each: "code value; code value; …".
std::string dxf(const std::string& groups) {
  std::istringstream input(groups);
  std::string text, group;
  while (std::getline(input, group, ';')) {
    const std::size_t code = group.find_first_not_of(" \n");
    if (code == std::string::npos) continue;
    const std::size_t space = group.find(' ', code);
    text += "  " + group.substr(code, space - code) + "\r\n" + group.substr(space + 1) + "\r\n";
  }
  return text;
}

std::string polyline(int layer, const std::vector<Vec2d>& points, bool closed = true) {
  std::ostringstream out;
  out << "0 POLYLINE; 8 " << layer << "; 66 1; 70 " << closed << ";";
  for (const Vec2d& p : points)
    out << "0 VERTEX; 8 " << layer << "; 10 " << p.x << "; 20 " << p.y << "; 30 0.0;";
  out << "0 SEQEND;";
  return out.str();
}

std::string line(int layer, Vec2d a, Vec2d b) {
  std::ostringstream out;
  out << "0 LINE; 8 " << layer << "; 10 " << a.x << "; 20 " << a.y << "; 11 " << b.x << "; 21 "
      << b.y << ";";
  return out.str();
}

std::string turn_points(const std::vector<Vec2d>& points) {
  std::ostringstream out;
  for (const Vec2d& p : points) out << "0 POINT; 8 2; 10 " << p.x << "; 20 " << p.y << ";";
  return out.str();
}

std::string block(const std::string& name, const std::string& content) {
  return "0 BLOCK; 8 1; 2 " + name + "; 70 64; 10 0.0; 20 0.0;" + content + "0 ENDBLK;";
}

std::string file(const std::string& blocks) {
  return dxf("0 SECTION; 2 BLOCKS;" + blocks +
             "0 ENDSEC; 0 SECTION; 2 ENTITIES; 0 INSERT; 2 A; 10 0; 20 0; 0 ENDSEC; 0 EOF;");
}

Pattern parsed(const std::string& blocks) { return parse_pattern_dxf(file(blocks), "test.dxf"); }

bool has_note(const Pattern& pattern, const std::string& word) {
  return std::ranges::any_of(
      pattern.notes, [&](const std::string& note) { return note.find(word) != std::string::npos; });
}

void expect_refused(const std::string& text, const std::vector<std::string>& words) {
  try {
    parse_pattern_dxf(text, "test.dxf");
    ADD_FAILURE() << "no error, expected one with " << words.front();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("test.dxf: ")) << message;
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' not in: " << message;
  }
}

const std::vector<Vec2d> kRectangle{{0, 0}, {400, 0}, {400, 600}, {0, 600}};

TEST(Dxf, TheSewLineIsTakenBeforeTheCutLine) {
  const Pattern pattern =
      parsed(block("A", polyline(1, {{-10, -10}, {410, -10}, {410, 610}, {-10, 610}}) +
                            polyline(14, kRectangle)));
  ASSERT_EQ(pattern.panels.size(), 1u);
  EXPECT_EQ(pattern.panels[0].name, "A");
  EXPECT_NEAR(signed_area(pattern.panels[0]), 0.24, 1e-12);
  EXPECT_EQ(pattern.panels[0].edges.size(), 4u);
  EXPECT_FALSE(has_note(pattern, "cut line"));
  EXPECT_TRUE(has_note(pattern, "no stitches"));
}

TEST(Dxf, WithoutASewLineTheCutLineIsTakenAndSaid) {
  const Pattern pattern = parsed(block("A", polyline(1, kRectangle)));
  EXPECT_NEAR(signed_area(pattern.panels[0]), 0.24, 1e-12);
  EXPECT_TRUE(has_note(pattern, "panel 'A': has no sew line"));
}

TEST(Dxf, TheSizeTellsTheUnits) {
  const auto small = [](double scale) {
    std::vector<Vec2d> points;
    for (const Vec2d& p : kRectangle) points.push_back(scale * p);
    return polyline(14, points);
  };
  EXPECT_NEAR(signed_area(parsed(block("A", small(1))).panels[0]), 0.24, 1e-12);
  EXPECT_TRUE(has_note(parsed(block("A", small(1))), "millimetres"));
  EXPECT_NEAR(signed_area(parsed(block("A", small(0.1))).panels[0]), 0.24, 1e-12);
  EXPECT_TRUE(has_note(parsed(block("A", small(0.1))), "centimetres"));
  const Pattern inches = parsed(block("A", small(1 / 25.4) + "0 TEXT; 8 1; 1 Units: ENGLISH;"));
  EXPECT_NEAR(signed_area(inches.panels[0]), 0.24, 1e-5);
}

TEST(Dxf, TurnPointsDivideTheOutline) {
  // A corner in the middle of a straight side, and none where the outline turns.
  const Pattern pattern =
      parsed(block("A", polyline(14, {{0, 0}, {200, 0}, {400, 0}, {400, 600}, {0, 600}}) +
                            turn_points({{200, 0}, {400, 600}, {0, 600}})));
  const Panel& panel = pattern.panels[0];
  ASSERT_EQ(panel.edges.size(), 3u);
  std::vector<double> lengths;
  for (const PanelEdge& edge : panel.edges) lengths.push_back(EdgePath(panel, edge).length());
  std::ranges::sort(lengths);
  EXPECT_NEAR(lengths[0], 0.4, 1e-12);
  EXPECT_NEAR(lengths[1], 0.8, 1e-12);
  EXPECT_NEAR(lengths[2], 0.8, 1e-12);
  EXPECT_NEAR(perimeter(panel), 2.0, 1e-12);
}

TEST(Dxf, WithoutTurnPointsSharpTurnsAreCorners) {
  // Half a disc: an arc of small turns over a diameter.
  std::vector<Vec2d> points;
  for (int i = 0; i <= 40; ++i) {
    const double a = i * 3.14159265358979 / 40;
    points.push_back({300 * std::cos(a), 300 * std::sin(a)});
  }
  const Pattern pattern = parsed(block("A", polyline(14, points)));
  ASSERT_EQ(pattern.panels[0].edges.size(), 2u);
  EXPECT_EQ(pattern.panels[0].edges[0].curve, EdgeCurve::polyline);
  EXPECT_EQ(pattern.panels[0].edges[1].curve, EdgeCurve::straight);

  // Points on the polyline are evenly spaced, and the panel can be meshed.
  const EdgePath path(pattern.panels[0], pattern.panels[0].edges[0]);
  const Vec2d middle = path.at(0.5), start = path.at(0);
  EXPECT_NEAR(std::hypot(middle.x - start.x, middle.y - start.y), 0.3 * std::sqrt(2.0), 1e-9);
  const SewnGarment garment = sew_pattern(pattern, 0.02);
  EXPECT_NEAR(static_cast<double>(garment.mesh.faces.size()), 2.31 * 0.1414 / 4e-4, 100);
}

TEST(Dxf, LinesThatMeetMakeOneOutline) {
  const Pattern pattern =
      parsed(block("A", line(14, {0, 0}, {400, 0}) + line(14, {400, 600}, {400, 0}) +
                            polyline(14, {{0, 0}, {0, 600}, {400, 600}}, false)));
  EXPECT_NEAR(signed_area(pattern.panels[0]), 0.24, 1e-12);
  EXPECT_EQ(pattern.panels[0].edges.size(), 4u);
}

TEST(Dxf, HalfPiecesAreUnfolded) {
  const Pattern pattern = parsed(block(
      "A", polyline(14, {{0, 0}, {200, 0}, {250, 600}, {0, 500}}) + line(6, {0, 0}, {0, 500})));
  const Panel& panel = pattern.panels[0];
  EXPECT_NEAR(signed_area(panel), 0.245, 1e-12);
  EXPECT_EQ(panel.corners.size(), 6u);

  // The half's outline without the fold, twice; and as wide to the left as to the right.
  const double half = 0.2 + std::hypot(0.05, 0.6) + std::hypot(0.25, 0.1);
  EXPECT_NEAR(perimeter(panel), 2 * half, 1e-12);
  const auto [left, right] = std::ranges::minmax(panel.corners, {}, &Vec2d::x);
  EXPECT_NEAR(right.x - left.x, 0.5, 1e-12);
  EXPECT_TRUE(has_note(parsed(block("A", polyline(14, kRectangle) + line(6, {9, 9}, {50, 50}))),
                       "mirror line is not an edge"));
}

TEST(Dxf, TheGrainIsTurnedToY) {
  const Pattern pattern =
      parsed(block("A", polyline(14, kRectangle) + line(7, {100, 100}, {300, 100})));
  const auto [left, right] = std::ranges::minmax(pattern.panels[0].corners, {}, &Vec2d::x);
  EXPECT_NEAR(right.x - left.x, 0.6, 1e-12);  // what was up is across now
}

TEST(Dxf, TwoOfAPieceAreMirrorImages) {
  const Pattern pattern =
      parsed(block("A", polyline(14, {{0, 0}, {400, 0}, {0, 600}}) +
                            "0 TEXT; 8 1; 1 Piece Name: SLEEVE; 0 TEXT; 8 1; 1 Quantity: 2;"));
  ASSERT_EQ(pattern.panels.size(), 2u);
  EXPECT_EQ(pattern.panels[0].name, "SLEEVE");
  EXPECT_EQ(pattern.panels[1].name, "SLEEVE mirrored");
  for (const Panel& panel : pattern.panels) {
    EXPECT_NEAR(signed_area(panel), 0.12, 1e-12);
    EXPECT_FALSE(panel.clockwise);
  }
  const auto lowest_right = [](const Panel& panel) {
    return std::ranges::max(panel.corners, {}, [](Vec2d p) { return p.x - p.y; });
  };
  EXPECT_GT(lowest_right(pattern.panels[0]).x, 0.2);
  EXPECT_LT(lowest_right(pattern.panels[1]).x, 0.2);
}

TEST(Dxf, NamesAreMadeUnique) {
  const Pattern pattern =
      parsed(block("A", polyline(14, kRectangle)) + block("A", polyline(14, kRectangle)));
  EXPECT_EQ(pattern.panels[1].name, "A 2");
}

TEST(Dxf, BrokenFilesAreRefusedWithTheLine) {
  expect_refused("", {"0 pieces", "layer 14"});
  expect_refused("x\r\n1\r\n", {"line 1", "'x'", "DXF group"});
  expect_refused("0\r\nSECTION\r\n10", {"line 3", "(end of file)"});
  expect_refused(file(block("A", "0 LINE; 8 14; 10 abc;")), {"'abc'", "a number"});
  expect_refused(file(block("A", "0 LINE; 8 14; 10 1e300;")), {"'1e300'", "a number"});
  expect_refused(file(block("A", polyline(14, {{0, 0}, {400, 0}, {400, 600}}, false))),
                 {"0 pieces"});
  expect_refused(file(block("A", polyline(14, {{0, 0}, {400, 400}, {400, 0}, {0, 500}}))),
                 {"panel 'A'", "crosses itself"});
  std::string many;
  for (std::size_t i = 0; i <= kMostPanels; ++i) many += block("A", "");
  expect_refused(file(many), {"at most 1000 blocks"});
}

}  // namespace
}  // namespace icloth
