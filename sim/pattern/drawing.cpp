#include "sim/pattern/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/index.h"
#include "sim/files/text.h"
#include "sim/pattern/outline.h"

namespace icloth {
namespace {

constexpr double kMargin = 6;  ///< around every panel [cm]

/// A number with two digits, which are 0.1 mm.
std::string fixed(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

/// Text of the file, as a drawing may repeat it.
std::string written(const std::string& input) { return markup_text(excerpt(input)); }

/// A panel on the page: from metres in its plane to centimetres with y downwards.
struct OnPage {
  double left = 0, top = 0;  ///< of the box with the panel and its margin [cm]
  Vec2d low, high;           ///< of the panel [m]

  double width() const { return 100 * (high.x - low.x) + 2 * kMargin; }
  double height() const { return 100 * (high.y - low.y) + 2 * kMargin; }
  Vec2d operator()(Vec2d p) const {
    return {left + kMargin + 100 * (p.x - low.x), top + kMargin + 100 * (high.y - p.y)};
  }
};

OnPage box_of(const Panel& panel) {
  OnPage page;
  page.low = {1e300, 1e300};
  page.high = {-1e300, -1e300};
  for (const Vec2d& p : outline_polygon(panel, 16)) {
    page.low = {std::min(page.low.x, p.x), std::min(page.low.y, p.y)};
    page.high = {std::max(page.high.x, p.x), std::max(page.high.y, p.y)};
  }
  return page;
}

/// Puts the panels into rows, in their order.
std::vector<OnPage> lay_out(const Pattern& pattern, double& width, double& height) {
  std::vector<OnPage> pages;
  double area = 0, widest = 0;
  for (const Panel& panel : pattern.panels) {
    pages.push_back(box_of(panel));
    area += pages.back().width() * pages.back().height();
    widest = std::max(widest, pages.back().width());
  }

  // The rows are as wide as makes the page a little wider than high.
  const double row_width = std::max(widest, 1.3 * std::sqrt(area));
  double x = 0, y = 0, row_height = 0;
  width = 0;
  for (OnPage& page : pages) {
    if (x > 0 && x + page.width() > row_width) x = 0, y += row_height, row_height = 0;
    page.left = x;
    page.top = y;
    x += page.width();
    row_height = std::max(row_height, page.height());
    width = std::max(width, x);
  }
  height = y + row_height;
  return pages;
}

class Drawing {
 public:
  explicit Drawing(const Pattern& pattern) : pattern_(pattern) {
    stitch_of_.resize(pattern.panels.size());
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
      stitch_of_[p].resize(pattern.panels[p].edges.size(), -1);
    for (std::size_t s = 0; s < pattern.stitches.size(); ++s)
      for (const PanelSide& side : pattern.stitches[s].sides)
        stitch_of_[at(side.panel)][at(side.edge)] = static_cast<int>(s);
  }

  std::string svg() {
    double width = 0, height = 0;
    const std::vector<OnPage> pages = lay_out(pattern_, width, height);
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + fixed(10 * width) +
           "mm\" height=\"" + fixed(10 * height) + "mm\" viewBox=\"0 0 " + fixed(width) + ' ' +
           fixed(height) +
           "\" font-family=\"sans-serif\" text-anchor=\"middle\" dominant-baseline=\"central\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    for (std::size_t p = 0; p < pages.size(); ++p) draw_panel(p, pages[p]);
    return svg_ + "</svg>\n";
  }

 private:
  void draw_panel(std::size_t p, const OnPage& page);
  void draw_edge(std::size_t p, std::size_t e, const OnPage& page);
  void draw_grain(const Panel& panel, const OnPage& page);
  std::string curve_to(const Panel& panel, const PanelEdge& edge, const OnPage& page) const;
  void write(Vec2d place, double size, const std::string& colour, const std::string& text) {
    svg_ += "<text x=\"" + fixed(place.x) + "\" y=\"" + fixed(place.y) + "\" font-size=\"" +
            fixed(size) + "\" fill=\"" + colour + "\">" + text + "</text>\n";
  }

  const Pattern& pattern_;
  std::vector<std::vector<int>> stitch_of_;  ///< of each edge of each panel; −1: none
  std::string svg_;
};

/// The rest of an SVG path from the start of an edge to its end.
std::string Drawing::curve_to(const Panel& panel, const PanelEdge& edge, const OnPage& page) const {
  const auto place = [&](Vec2d p) { return fixed(page(p).x) + ' ' + fixed(page(p).y); };
  const std::string end = place(panel.corners[at(edge.end)]);
  if (edge.curve == EdgeCurve::straight) return "L " + end;
  if (edge.curve == EdgeCurve::polyline) {
    std::string line = "L ";
    for (const Vec2d& p : edge.points) line += place(p) + ' ';
    return line + end;
  }
  if (edge.curve == EdgeCurve::quadratic) return "Q " + place(edge.control[0]) + ' ' + end;
  if (edge.curve == EdgeCurve::cubic)
    return "C " + place(edge.control[0]) + ' ' + place(edge.control[1]) + ' ' + end;

  // The page looks downwards, so that the turn of an arc is the other one there.
  const std::string radius = fixed(100 * edge.radius);
  return "A " + radius + ' ' + radius + " 0 " + (edge.large_arc ? '1' : '0') + ' ' +
         (edge.counter_clockwise ? '0' : '1') + ' ' + end;
}

void Drawing::draw_panel(std::size_t p, const OnPage& page) {
  const Panel& panel = pattern_.panels[p];

  // The fabric, then the edges on top of it.
  const Vec2d first = page(panel.corners[at(panel.edges[0].start)]);
  svg_ += "<path fill=\"#f3efe6\" d=\"M " + fixed(first.x) + ' ' + fixed(first.y);
  for (const PanelEdge& edge : panel.edges) svg_ += ' ' + curve_to(panel, edge, page);
  svg_ += " Z\"/>\n";
  draw_grain(panel, page);
  for (std::size_t e = 0; e < panel.edges.size(); ++e) draw_edge(p, e, page);

  // Name and area stand in the middle of the box, which is inside of most panels.
  const Vec2d middle = page(0.5 * (page.low + page.high));
  write(middle, 2.4, "#202020", written(panel.name));
  const std::string label = panel.label.empty() ? "" : written(panel.label) + ", ";
  const std::string side = panel.clockwise ? ", wrong side" : "";
  write(middle + Vec2d{0, 2.4}, 1.4, "#606060",
        label + std::to_string(std::lround(1e4 * std::fabs(signed_area(panel)))) + " cm²" + side);
}

/// An arrow along the grain, which is the direction of y.
void Drawing::draw_grain(const Panel& panel, const OnPage& page) {
  const Vec2d middle = page(0.5 * (page.low + page.high));
  const double length = std::min(16.0, 30 * (page.high.y - page.low.y));
  const Vec2d tip = middle + Vec2d{0, -2.4 - length}, foot = middle + Vec2d{0, -2.4};
  svg_ += "<path fill=\"none\" stroke=\"#a09880\" stroke-width=\"0.2\" d=\"M " + fixed(foot.x) +
          ' ' + fixed(foot.y) + " L " + fixed(tip.x) + ' ' + fixed(tip.y) + " m -0.6 1.4 L " +
          fixed(tip.x) + ' ' + fixed(tip.y) + " l 0.6 1.4\"><title>grain of " +
          written(panel.name) + "</title></path>\n";
}

void Drawing::draw_edge(std::size_t p, std::size_t e, const OnPage& page) {
  const Panel& panel = pattern_.panels[p];
  const PanelEdge& edge = panel.edges[e];
  const int stitch = stitch_of_[p][e];
  const std::string colour =
      stitch < 0 ? "#202020" : stitch_colour(static_cast<std::size_t>(stitch));

  // A sewn edge is wide, a free one thin. A dot marks where it starts.
  const Vec2d start = page(panel.corners[at(edge.start)]);
  svg_ += "<path fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"" +
          (stitch < 0 ? "0.25" : "0.6") + "\" d=\"M " + fixed(start.x) + ' ' + fixed(start.y) +
          ' ' + curve_to(panel, edge, page) + "\"/>\n<circle r=\"0.45\" fill=\"#202020\" cx=\"" +
          fixed(start.x) + "\" cy=\"" + fixed(start.y) + "\"/>\n";

  // The number of the edge is inside of the panel; the stitch and the label are outside.
  const EdgePath path(panel, edge);
  const Vec2d a = page(path.at(0.45)), b = page(path.at(0.55)), middle = page(path.at(0.5));
  const double length = std::max(std::hypot(b.x - a.x, b.y - a.y), 1e-9);
  const double side = (panel.clockwise ? -1 : 1) / length;
  const Vec2d inwards{side * (b.y - a.y), side * (a.x - b.x)};
  write(middle + 1.7 * inwards, 1.8, colour, std::to_string(e));
  if (stitch >= 0)
    write(middle - 1.5 * inwards, 1.1, colour, std::string("s").append(std::to_string(stitch)));

  // Labels of neighbouring edges are at two distances, so that long ones pass each other.
  if (!edge.label.empty())
    write(middle - (e % 2 == 0 ? 2.9 : 4.0) * inwards, 0.9, colour, written(edge.label));
}

}  // namespace

std::string stitch_colour(std::size_t stitch) {
  // Steps of the golden angle keep the hues of few stitches far apart.
  const auto hue = static_cast<int>(std::fmod(137.5 * static_cast<double>(stitch), 360));
  return "hsl(" + std::to_string(hue) + ", 75%, " + (stitch % 2 == 0 ? "38%" : "48%") + ")";
}

std::string pattern_svg(const Pattern& pattern) { return Drawing(pattern).svg(); }

}  // namespace icloth
