// What the reader of patterns accepts, and what it says about what it does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/files/error.h"
#include "sim/pattern/outline.h"
#include "sim/pattern/pattern_checks.h"
#include "tests/sim/pattern/pattern_support.h"

namespace icloth {
namespace {

/// The text must be refused in one line with all the words.
void expect_refused(const std::string& text, const std::vector<std::string>& words) {
  try {
    parsed(text);
    ADD_FAILURE() << "no error, expected one with " << words.front();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("test.json: ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : words)
      EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' not in: " << message;
  }
}

/// One note must have all the words.
void expect_note(const std::vector<std::string>& notes, const std::vector<std::string>& words) {
  const bool found = std::ranges::any_of(notes, [&](const std::string& note) {
    return std::ranges::all_of(
        words, [&](const std::string& word) { return note.find(word) != std::string::npos; });
  });
  std::string all;
  for (const std::string& note : notes) all += "\n" + note;
  EXPECT_TRUE(found) << "no note with '" << words.front() << "' in:" << all;
}

bool has_note(const Pattern& pattern, const std::string& word) {
  return std::ranges::any_of(
      pattern.notes, [&](const std::string& note) { return note.find(word) != std::string::npos; });
}

/// A triangle of 40 cm with other edges.
std::string triangle(const std::string& edges) {
  return pattern_file(R"("t": {"vertices": [[0, 0], [40, 0], [0, 40]], "edges": [)" + edges + "]}");
}
std::string triangle_with(const std::string& of_first_edge) {
  return triangle(R"({"endpoints": [0, 1], )" + of_first_edge +
                  R"(}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]})");
}

TEST(PatternReader, LengthsAreMetresWhateverTheUnits) {
  const std::string circle = R"("curvature": {"type": "circle", "params": [15, 0, 1]})";
  for (const double units : {100.0, 300.0}) {
    const Pattern pattern =
        parsed(pattern_file(R"("p": {"vertices": [[0, 0], [30, 0], [30, 60], [0, 60]],
            "edges": [{"endpoints": [0, 1], )" +
                                circle + R"(}, {"endpoints": [1, 2]},
            {"endpoints": [2, 3]}, {"endpoints": [3, 0]}], "translation": [3, 6, 9],
            "rotation": [10, 20, 30], "bend_radius": 12})",
                            "", R"("units_in_meter": )" + std::to_string(units)));
    const Panel& panel = pattern.panels[0];
    EXPECT_NEAR(panel.corners[1].x, 30 / units, 1e-15);
    EXPECT_NEAR(panel.edges[0].radius, 15 / units, 1e-15);
    EXPECT_NEAR(panel.placement.translation.z, 9 / units, 1e-15);
    EXPECT_NEAR(panel.placement.bend_radius, 12 / units, 1e-15);
    EXPECT_EQ(panel.placement.rotation.y, 20);
  }
}

TEST(PatternReader, MissingUnitsAreCentimetresAndSaid) {
  const Pattern pattern = parsed(pattern_file(rectangle("p", 50, 40), "", ""));
  EXPECT_NEAR(pattern.panels[0].corners[1].x, 0.5, 1e-15);
  expect_note(pattern.notes, {"units_in_meter is missing", "centimetres"});
  EXPECT_FALSE(has_note(parsed(pattern_file(rectangle("p", 50, 40))), "units"));
}

TEST(PatternReader, ControlPointsCanBeRelativeOrAbsolute) {
  const auto control = [](const std::string& properties, const char* point) {
    const std::string panels = R"("t": {"vertices": [[0, 0], [40, 0], [0, 40]], "edges": [
        {"endpoints": [0, 1], "curvature": {"type": "quadratic", "params": [)" +
                               std::string(point) + R"(]}}, {"endpoints": [1, 2]},
        {"endpoints": [2, 0]}]})";
    const Pattern pattern =
        parsed(pattern_file(panels, "", R"("units_in_meter": 100, )" + properties));
    // Relative to the first corner, which panels may be moved by.
    return pattern.panels[0].edges[0].control[0] - pattern.panels[0].corners[0];
  };
  for (const auto& [properties, point] :
       {std::pair{R"("curvature_coords": "relative")", "[0.5, 0.1]"},
        std::pair{R"("curvature_coords": "absolute")", "[20, 4]"},
        std::pair{R"("curvature_coords": "absolute", "normalize_panel_translation": true)",
                  "[20, 4]"}}) {
    SCOPED_TRACE(properties);
    EXPECT_NEAR(control(properties, point).x, 0.20, 1e-15);
    EXPECT_NEAR(control(properties, point).y, 0.04, 1e-15);
  }
}

TEST(PatternReader, AListIsTheOlderFormOfAQuadraticCurve) {
  const Pattern list = parsed(triangle_with(R"("curvature": [0.3, 0.2])"));
  const Pattern object =
      parsed(triangle_with(R"("curvature": {"type": "quadratic", "params": [[0.3, 0.2]]})"));
  EXPECT_EQ(list.panels[0].edges[0].curve, EdgeCurve::quadratic);
  EXPECT_EQ(signed_area(list.panels[0]), signed_area(object.panels[0]));
}

TEST(PatternReader, CentredPanelsStayWhereTheyAre) {
  const Pattern pattern =
      parsed(pattern_file(rectangle("p", 40, 60, R"("translation": [1, 2, 3])"), "",
                          R"("units_in_meter": 100, "normalize_panel_translation": true)"));
  EXPECT_NEAR(pattern.panels[0].corners[0].x, -0.2, 1e-15);
  EXPECT_NEAR(pattern.panels[0].placement.translation.x, 0.21, 1e-15);
  EXPECT_NEAR(pattern.panels[0].placement.translation.y, 0.32, 1e-15);
  EXPECT_NEAR(pattern.panels[0].placement.translation.z, 0.03, 1e-15);
}

TEST(PatternReader, ClockwisePanelsAreMarked) {
  const Pattern pattern =
      parsed(triangle(R"({"endpoints": [0, 2]}, {"endpoints": [2, 1]}, {"endpoints": [1, 0]})"));
  EXPECT_TRUE(pattern.panels[0].clockwise);
  EXPECT_FALSE(parsed(triangle_with(R"("label": "a")")).panels[0].clockwise);
}

TEST(PatternReader, PanelsHaveTheOrderOfTheFile) {
  const std::string text =
      R"({"pattern": {"panels": {)" + rectangle("a", 40, 40) + "," + rectangle("b", 40, 40) + "," +
      rectangle("c", 40, 40) +
      R"(}, "panel_order": ["c", "nosuch", "a", "c"]}, "properties": {"units_in_meter": 100}})";
  const Pattern pattern = parsed(text);
  ASSERT_EQ(pattern.panels.size(), 3u);
  EXPECT_EQ(pattern.panels[0].name + pattern.panels[1].name + pattern.panels[2].name, "cab");
}

TEST(PatternReader, LabelsAndStitchesAreKept) {
  const Pattern pattern =
      parsed(pattern_file(rectangle("a", 40, 40, R"("label": "body", "unknown": {"x": 1})") + "," +
                              rectangle("b", 40, 40),
                          stitch("a", 1, "b", 3) + "," + stitch("a", 3, "b", 1, "right_wrong")));
  EXPECT_EQ(pattern.panels[0].label, "body");
  ASSERT_EQ(pattern.stitches.size(), 2u);
  EXPECT_EQ(pattern.stitches[0].sides[0].panel, 0);
  EXPECT_EQ(pattern.stitches[0].sides[1].edge, 3);
  EXPECT_FALSE(pattern.stitches[0].right_wrong);
  EXPECT_TRUE(pattern.stitches[1].right_wrong);
  EXPECT_EQ(parsed(triangle_with(R"("label": "collar")")).panels[0].edges[0].label, "collar");
}

TEST(PatternReader, LoopsThatAreNotClosedAreRefused) {
  expect_refused(triangle(R"({"endpoints": [0, 1]}, {"endpoints": [2, 0]}, {"endpoints": [1, 2]})"),
                 {"panel 't'", "edge 0 ends at corner 1", "edge 1 starts at corner 2", "closed"});
  expect_refused(triangle(R"({"endpoints": [0, 1]}, {"endpoints": [1, 2]})"),
                 {"edge 1 ends at corner 2", "edge 0 starts at corner 0"});
}

TEST(PatternReader, OutlinesThatCrossOrMeetThemselvesAreRefused) {
  expect_refused(pattern_file(R"("bow": {"vertices": [[0, 0], [40, 40], [40, 0], [0, 50]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
      {"endpoints": [3, 0]}]})"),
                 {"panel 'bow'", "crosses itself"});
  // A curve that bulges through the opposite corner.
  expect_refused(triangle_with(R"("curvature": [0.3, 3])"), {"panel 't'", "crosses itself"});
  expect_refused(
      pattern_file(R"("eight": {"vertices": [[0, 0], [40, 0], [0, 40], [-40, 0], [0, -40]],
      "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 0]},
      {"endpoints": [0, 3]}, {"endpoints": [3, 4]}, {"endpoints": [4, 0]}]})"),
      {"panel 'eight'", "corner 0 twice"});
}

TEST(PatternReader, PanelsWithoutAreaAreRefused) {
  expect_refused(pattern_file(rectangle("p", 0.9, 0.9)),
                 {"panel 'p'", "0.81 cm²", "at least 1 cm²"});
  expect_refused(pattern_file(rectangle("p", 40, 0)), {"panel 'p'", "edge 1", "no length"});
  expect_refused(pattern_file(rectangle("p", 1e6, 40)), {"panel 'p'", "at most 50 m"});
}

TEST(PatternReader, StitchesOfUnknownOrUsedEdgesAreRefused) {
  const std::string two = rectangle("front", 40, 60) + "," + rectangle("back", 40, 60);
  expect_refused(pattern_file(two, stitch("frnt", 1, "back", 3)),
                 {"stitch 0", "\"frnt\"", "nearest is 'front'"});
  expect_refused(pattern_file(two, stitch("front", 4, "back", 3)),
                 {"stitch 0", "value 4", "edge of panel 'front'", "0 to 3"});
  expect_refused(
      pattern_file(two, stitch("front", 1, "back", 3) + "," + stitch("front", 3, "back", 3)),
      {"stitch 1", "edge 3 of panel 'back'", "sewn twice", "stitch 0"});
  expect_refused(pattern_file(two, stitch("front", 1, "front", 1)), {"stitch 0", "sewn to itself"});
  expect_refused(pattern_file(two, stitch("front", 1, "back", 3, "wrong")),
                 {"stitch 0", "\"wrong\"", "right_wrong"});
  expect_refused(pattern_file(two, R"([{"panel": "front", "edge": 1}])"),
                 {"stitch 0", "two edges"});
  expect_refused(pattern_file(two, R"([{"panel": "front"}, {"panel": "back", "edge": 1}])"),
                 {"stitch 0", "'edge'", "missing"});
}

TEST(PatternReader, BrokenElementsAreNamed) {
  expect_refused("[]", {"object"});
  expect_refused("{}", {"'pattern'"});
  expect_refused("{\"pattern\": {}}", {"panels", "missing"});
  expect_refused(pattern_file(""), {"panels", "not 0"});
  expect_refused("{\"pattern\"", {"line 1"});
  expect_refused(pattern_file(R"("p": 7)"), {"panel 'p'", "value 7"});
  expect_refused(pattern_file(R"("p": {"edges": []})"), {"panel 'p'", "vertices", "missing"});
  expect_refused(pattern_file(R"("p": {"vertices": [[0, 0], [1]], "edges": []})"),
                 {"panel 'p'", "vertices[1]", "2 numbers"});
  expect_refused(pattern_file(R"("p": {"vertices": [[0, 1e30]], "edges": []})"),
                 {"vertices[0]", "2 numbers"});
  expect_refused(triangle(R"({"endpoints": [0, 1]})"), {"panel 't'", "at least 2 edges"});
  expect_refused(triangle(R"({"endpoints": [0, 3]}, {"endpoints": [3, 0]})"),
                 {"panel 't'", "edge 0", "value 3", "0 to 2"});
  expect_refused(triangle(R"({"endpoints": [0, 1.5]}, {"endpoints": [3, 0]})"), {"1.5"});
  expect_refused(triangle(R"({"endpoints": [0]}, {"endpoints": [3, 0]})"), {"two corners"});
  expect_refused(pattern_file(rectangle("p", 40, 40, R"("translation": [1, 2])")),
                 {"panel 'p'", "translation", "3 numbers"});
  expect_refused(pattern_file(rectangle("p", 40, 40, R"("bend_radius": 0.01)")),
                 {"panel 'p'", "bend_radius", "0.01", "1 mm"});
  expect_refused(pattern_file(rectangle("p", 40, 40), "", R"("units_in_meter": 0)"),
                 {"units_in_meter", "value 0"});
  expect_refused(pattern_file(rectangle("p", 40, 40), "", R"("curvature_coords": "polar")"),
                 {"curvature_coords", "\"polar\"", "\"relative\""});
}

TEST(PatternReader, BrokenCurvesAreNamed) {
  expect_refused(triangle_with(R"("curvature": 3)"), {"panel 't'", "edge 0", "curvature"});
  expect_refused(triangle_with(R"("curvature": [1, 2, 3])"), {"edge 0", "2 numbers"});
  expect_refused(triangle_with(R"("curvature": {"type": "nurbs", "params": []})"),
                 {"edge 0", "\"nurbs\"", "\"cubic\""});
  expect_refused(triangle_with(R"("curvature": {"type": "cubic", "params": [[0, 0]]})"),
                 {"edge 0", "two control points"});
  expect_refused(triangle_with(R"("curvature": {"type": "circle", "params": [3, 0]})"),
                 {"edge 0", "radius"});
  expect_refused(triangle_with(R"("curvature": {"type": "circle", "params": [-3, 0, 1]})"),
                 {"edge 0", "params[0]", "-3"});
  expect_refused(triangle_with(R"("curvature": {"type": "circle", "params": [30, 2, 1]})"),
                 {"edge 0", "params[1]", "value 2"});
  expect_refused(triangle_with(R"("curvature": [1e6, 0])"), {"edge 0", "near the panel"});
}

TEST(PatternReader, RadiiThatRoundingLeftTooSmallAreHalfTheChord) {
  const char* format = R"("curvature": {"type": "circle", "params": [)";
  const Pattern rounded = parsed(triangle_with(format + std::string("19.9999, 0, 1]}")));
  EXPECT_EQ(rounded.panels[0].edges[0].radius, 0.2);
  EXPECT_FALSE(has_note(rounded, "radius"));
  const Pattern small = parsed(triangle_with(format + std::string("12, 0, 1]}")));
  EXPECT_EQ(small.panels[0].edges[0].radius, 0.2);
  expect_note(small.notes, {"panel 't'", "edge 0", "12 cm", "20 cm is taken"});
}

TEST(PatternReader, UnlikelyLengthsAreNoted) {
  const std::string two = rectangle("a", 40, 60) + "," + rectangle("b", 40, 10);
  expect_note(parsed(pattern_file(two, stitch("a", 1, "b", 3))).notes,
              {"stitch 0 (a:1 – b:3)", "60 cm to 10 cm", "ratio 6", "mistake"});
  expect_note(parsed(pattern_file(two, stitch("a", 1, "b", 2))).notes,
              {"1 of 1 stitches gather", "1.5"});
}

TEST(PatternReader, UnlikelySizesAndPlacesAreNoted) {
  expect_note(parsed(pattern_file(rectangle("p", 20, 20))).notes,
              {"0.2 m large", "units_in_meter"});
  expect_note(parsed(pattern_file(rectangle("p", 20, 320))).notes, {"3.2 m large"});
  const std::string same = rectangle("a", 40, 60) + "," + rectangle("b", 40, 60);
  expect_note(parsed(pattern_file(same)).notes, {"all panels are at one place"});
  const Pattern apart = parsed(pattern_file(rectangle("a", 40, 60, R"("translation": [0, 0, 20])") +
                                            "," + rectangle("b", 40, 60)));
  EXPECT_TRUE(apart.notes.empty());
}

TEST(PatternReader, BendsPastTheMiddleAreNoted) {
  // 25 cm on a radius of 20 cm reach back by 20 (1 − cos 1.25) = 13.7 cm.
  const auto panel = [](const char* z, const char* turn, const char* bend) {
    return pattern_file(R"("p": {"vertices": [[-25, 0], [25, 0], [25, 50], [-25, 50]], "edges": [
        {"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
        "translation": [0, 0, )" +
                        std::string(z) + R"(], "rotation": [0, )" + turn +
                        R"(, 0], "bend_radius": )" + bend + "}");
  };
  expect_note(parsed(panel("13", "0", "20")).notes, {"panel 'p'", "13.7 cm", "less than 13 cm"});
  EXPECT_TRUE(parsed(panel("17", "0", "20")).notes.empty());
  expect_note(parsed(panel("-13", "180", "20")).notes, {"13.7 cm"});
  expect_note(parsed(panel("-13", "0", "-20")).notes, {"13.7 cm"});
  EXPECT_TRUE(parsed(panel("-13", "0", "20")).notes.empty());  // bent outwards
}

TEST(PatternReader, StitchesThatCollapseAreNoted) {
  // A dart whose sides share corner 2: sewn from the tip it closes, the other way it collapses.
  const std::string dart = R"("d": {"vertices": [[0, 0], [18, 0], [20, 15], [22, 0], [40, 0],
      [40, 50], [0, 50]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]},
      {"endpoints": [2, 3]}, {"endpoints": [3, 4]}, {"endpoints": [4, 5]}, {"endpoints": [5, 6]},
      {"endpoints": [6, 0]}]})";
  EXPECT_TRUE(parsed(pattern_file(dart, stitch("d", 1, "d", 2))).notes.empty());
  expect_note(parsed(pattern_file(dart, stitch("d", 1, "d", 2, "right_wrong"))).notes,
              {"stitch 0 (d:1 – d:2)", "collapses"});

  // A tube closes the edges at its ends, and another tube may be sewn there.
  const std::string tubes =
      rectangle("a", 40, 60) + "," + rectangle("b", 40, 10, R"("translation": [0, -20, 0])");
  EXPECT_TRUE(parsed(pattern_file(tubes, stitch("a", 1, "a", 3) + "," + stitch("b", 1, "b", 3) +
                                             "," + stitch("a", 0, "b", 2)))
                  .notes.empty());
}

TEST(PatternReader, CountsAreBounded) {
  std::string panels, edges;
  for (std::size_t i = 0; i <= kMostPanels; ++i)
    panels.append(i == 0 ? "" : ",")
        .append(rectangle(std::string("p").append(std::to_string(i)), 40, 40));
  expect_refused(pattern_file(panels), {"panels", "1 to 1000", "1001"});
  for (std::size_t i = 0; i <= kMostPanelEdges; ++i)
    edges.append(i == 0 ? "" : ",").append(R"({"endpoints": [0, 1]})");
  expect_refused(triangle(edges), {"panel 't'", "edges", "at most 10000"});
}

struct Expected {
  const char* name;
  std::size_t panels, stitches, gathers;
};

TEST(PatternReader, PublicPatternsAreRead) {
  constexpr Expected kFiles[] = {{"dress_pencil", 6, 23, 11},       {"hoody_mean", 6, 12, 0},
                                 {"pants_straight_sides", 4, 6, 0}, {"shirt_mean", 8, 18, 0},
                                 {"skirt_4_panels", 4, 8, 0},       {"tee", 6, 12, 0},
                                 {"wb_dress_sleeveless", 6, 12, 4}};
  const std::vector<std::string> files = data_patterns();
  if (files.empty()) GTEST_SKIP() << "no patterns in " << ICLOTH_DATA_DEFAULT;
  for (const Expected& expected : kFiles) {
    SCOPED_TRACE(expected.name);
    const auto file = std::ranges::find_if(files, [&](const std::string& path) {
      return path.ends_with(std::string("/") + expected.name + "_specification.json");
    });
    ASSERT_NE(file, files.end());
    const Pattern pattern = read_pattern(*file);
    std::size_t gathers = 0;
    for (std::size_t s = 0; s < pattern.stitches.size(); ++s)
      gathers += stitch_ratio(pattern, s) > kGatherRatio;
    EXPECT_EQ(pattern.panels.size(), expected.panels);
    EXPECT_EQ(pattern.stitches.size(), expected.stitches);
    EXPECT_EQ(gathers, expected.gathers);
  }
}

}  // namespace
}  // namespace icloth
