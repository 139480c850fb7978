#include "sim/pattern/pattern_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/index.h"
#include "sim/files/box.h"
#include "sim/files/disjoint_sets.h"
#include "sim/files/error.h"
#include "sim/files/ring_crossings.h"
#include "sim/files/text.h"
#include "sim/pattern/outline.h"
#include "sim/pattern/sewing.h"

namespace icloth {
namespace {

constexpr int kCurveSegments = 32;                             ///< of a curve, for the checks
constexpr double kSmallestGarment = 0.3, kLargestGarment = 3;  ///< [m]

std::string cm(double metres) { return rounded_text(100 * metres) + " cm"; }

std::string panel_place(const Pattern& pattern, const Panel& panel) {
  return pattern.file + ": panel " + in_quotes(panel.name);
}

void check_loop(const Pattern& pattern, const Panel& panel) {
  for (std::size_t i = 0; i < panel.edges.size(); ++i) {
    const std::size_t next = (i + 1) % panel.edges.size();
    if (panel.edges[i].end == panel.edges[next].start) continue;
    throw InputError(panel_place(pattern, panel) + ": edge " + std::to_string(i) +
                     " ends at corner " + std::to_string(panel.edges[i].end) + ", edge " +
                     std::to_string(next) + " starts at corner " +
                     std::to_string(panel.edges[next].start) + ", expected a closed loop");
  }
}

void check_outline(const Pattern& pattern, Panel& panel) {
  // A corner where the loop passes twice is no corner of one piece of fabric.
  std::vector<char> passed(panel.corners.size(), 0);
  for (const PanelEdge& edge : panel.edges)
    if (std::exchange(passed[at(edge.start)], 1) != 0)
      throw InputError(panel_place(pattern, panel) + ": the outline passes corner " +
                       std::to_string(edge.start) + " twice, expected each corner once");

  std::vector<GridPoint> ring;
  for (const Vec2d& p : outline_polygon(panel, kCurveSegments)) {
    const double reach = std::max(std::fabs(p.x), std::fabs(p.y));
    if (!(reach <= kLargestReach))
      throw InputError(panel_place(pattern, panel) + ": value " + rounded_text(reach) +
                       " m from the origin of the panel, expected at most " +
                       number_text(kLargestReach) + " m");
    ring.push_back(to_grid(p));
  }
  if (crosses_itself(ring))
    throw InputError(panel_place(pattern, panel) +
                     ": the outline crosses itself, expected a simple loop");

  const double area = signed_area(panel);
  panel.clockwise = area < 0;
  if (std::fabs(area) < kSmallestPanel)
    throw InputError(panel_place(pattern, panel) + ": value " +
                     rounded_text(1e4 * std::fabs(area)) + " cm² of area, expected at least 1 cm²");
}

/// The corners of all panels in one numbering, and which of them stitches make one.
class SewnCorners {
 public:
  /// Sews all stitches but one (or none, with a number beyond them).
  SewnCorners(const Pattern& pattern, std::size_t left_out)
      : pattern_(pattern), first_(first_corners(pattern)), corners_(first_.back()) {
    for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
      if (s == left_out) continue;
      const Stitch& stitch = pattern.stitches[s];
      const auto [a0, a1] = ends(stitch.sides[0]);
      const auto [b0, b1] = ends(stitch.sides[1]);
      corners_.unite(a0, stitch.right_wrong ? b0 : b1);
      corners_.unite(a1, stitch.right_wrong ? b1 : b0);
    }
  }

  /// Whether the start and the end of an edge have become one.
  bool is_closed(PanelSide side) {
    const auto [a, b] = ends(side);
    return corners_.find(a) == corners_.find(b);
  }

 private:
  std::pair<std::size_t, std::size_t> ends(PanelSide side) const {
    const PanelEdge& edge = pattern_.panels[at(side.panel)].edges[at(side.edge)];
    return {first_[at(side.panel)] + at(edge.start), first_[at(side.panel)] + at(edge.end)};
  }
  /// The number of the first corner of each panel, and at last that of all corners.
  static std::vector<std::size_t> first_corners(const Pattern& pattern) {
    std::vector<std::size_t> first{0};
    for (const Panel& panel : pattern.panels) first.push_back(first.back() + panel.corners.size());
    return first;
  }

  const Pattern& pattern_;
  std::vector<std::size_t> first_;
  DisjointSets corners_;
};

/// Notes stitches that make one point of the two ends of an edge. A ring such as a cuff does not:
/// it is closed by another stitch already.
void note_collapsing_stitches(Pattern& pattern) {
  SewnCorners all(pattern, pattern.stitches.size());
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const auto& sides = pattern.stitches[s].sides;
    if (!all.is_closed(sides[0]) && !all.is_closed(sides[1])) continue;

    // Without this stitch, the edge of a ring is closed still.
    SewnCorners others(pattern, s);
    if (others.is_closed(sides[0]) || others.is_closed(sides[1])) continue;
    pattern.notes.push_back(pattern.file + ": " + stitch_name(pattern, s) +
                            " collapses: it sews both ends of an edge to one point; is its "
                            "direction right (\"right_wrong\")?");
  }
}

void note_lengths(Pattern& pattern) {
  // Each likely mistake is named by itself.
  std::size_t gathers = 0;
  double largest = 1;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const double ratio = stitch_ratio(pattern, s);
    if (ratio > kLikelyMistakeRatio)
      pattern.notes.push_back(pattern.file + ": " + stitch_name(pattern, s) + " sews " +
                              cm(stitched_length(pattern, s, 0)) + " to " +
                              cm(stitched_length(pattern, s, 1)) + ", ratio " +
                              rounded_text(ratio) + ": probably a mistake, expected at most " +
                              number_text(kLikelyMistakeRatio));
    else if (ratio > kGatherRatio)
      ++gathers, largest = std::max(largest, ratio);
  }

  // Gathers are common, and one line is enough for all of them.
  if (gathers > 0)
    pattern.notes.push_back(pattern.file + ": " + std::to_string(gathers) + " of " +
                            std::to_string(pattern.stitches.size()) +
                            " stitches gather or ease, by a ratio of up to " +
                            rounded_text(largest));
}

/// A panel that is bent back past the middle plane of the body meets the panels behind it.
void note_deep_bend(Pattern& pattern, const Panel& panel, const Box& flat, const Box& bent) {
  const bool faces_front = flat.size().z < 1e-6;
  if (!faces_front || panel.placement.bend_radius == 0) return;
  const double plane = flat.low.z;
  const double reach = plane > 0 ? plane - bent.low.z : bent.high.z - plane;
  if (reach < std::fabs(plane)) return;
  pattern.notes.push_back(panel_place(pattern, panel) + ": the bend of radius " +
                          cm(panel.placement.bend_radius) + " reaches back by " + cm(reach) +
                          ", past the middle of the body, expected less than " +
                          cm(std::fabs(plane)));
}

/// Notes about where the panels are: size, bends, and whether they are placed at all.
void note_placements(Pattern& pattern) {
  Box all;
  std::vector<Vec3d> middles;
  for (const Panel& panel : pattern.panels) {
    const std::vector<Vec2d> points = outline_polygon(panel, 8);
    Box flat, bent;
    PanelPlacement unbent = panel.placement;
    unbent.bend_radius = 0;
    for (const Vec3d& x : place_points(points, unbent)) flat.add(x);
    for (const Vec3d& x : place_points(points, panel.placement)) bent.add(x);
    all.add(bent);
    middles.push_back(0.5 * (flat.low + flat.high));
    note_deep_bend(pattern, panel, flat, bent);
  }

  const double size = norm_max(all.size());
  if (size < kSmallestGarment || size > kLargestGarment)
    pattern.notes.push_back(pattern.file + ": the garment is " + rounded_text(size) +
                            " m large, expected " + number_text(kSmallestGarment) + " to " +
                            number_text(kLargestGarment) + " m: is units_in_meter right?");
  const auto is_first = [&](Vec3d x) { return norm(x - middles[0]) < 1e-3; };
  if (middles.size() > 1 && std::ranges::all_of(middles, is_first))
    pattern.notes.push_back(pattern.file +
                            ": all panels are at one place, expected them around the body");
}

}  // namespace

double stitched_length(const Pattern& pattern, std::size_t stitch, std::size_t side) {
  const PanelSide edge = pattern.stitches[stitch].sides[side];
  const Panel& panel = pattern.panels[at(edge.panel)];
  return EdgePath(panel, panel.edges[at(edge.edge)]).length();
}

double stitch_ratio(const Pattern& pattern, std::size_t stitch) {
  const double a = stitched_length(pattern, stitch, 0), b = stitched_length(pattern, stitch, 1);
  return std::max(a, b) / std::min(a, b);
}

std::string stitch_name(const Pattern& pattern, std::size_t stitch) {
  const auto side = [&](PanelSide s) {
    return excerpt(pattern.panels[at(s.panel)].name) + ":" + std::to_string(s.edge);
  };
  const auto& sides = pattern.stitches[stitch].sides;
  return "stitch " + std::to_string(stitch) + " (" + side(sides[0]) + " – " + side(sides[1]) + ")";
}

void check_pattern(Pattern& pattern) {
  for (Panel& panel : pattern.panels) {
    check_loop(pattern, panel);
    check_outline(pattern, panel);
  }
  note_lengths(pattern);
  note_collapsing_stitches(pattern);
  note_placements(pattern);
}

}  // namespace icloth
