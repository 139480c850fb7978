// Sewing patterns, from the file to the sewn mesh.
#include <algorithm>

#include "sim/pattern/drawing.h"
#include "sim/pattern/sewing.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace icloth::fuzz {
namespace {

constexpr double kEdgeLength = 0.05;
constexpr Index kMostTriangles = 20'000;  ///< larger patterns get longer edges

void require_valid(const SewnGarment& garment, std::size_t panels) {
  fuzz::require_valid(garment.mesh);
  require(garment.panel.size() == garment.mesh.faces.size(), "a panel for every face");
  for (const Index p : garment.panel)
    require(p >= 0 && static_cast<std::size_t>(p) < panels, "panels that there are");
  for (const auto& uv : garment.mesh.uv) {
    const Vec2d a = uv[1] - uv[0], b = uv[2] - uv[0];
    require(a.x * b.y - a.y * b.x > 0, "material coordinates of positive area");
  }
}

void sew_and_check(const Pattern& pattern) {
  require(pattern_svg(pattern).ends_with("</svg>\n"), "a drawing");
  const double shortest = edge_length_for(pattern, kMostTriangles);
  require_valid(sew_pattern(pattern, std::max(kEdgeLength, shortest)), pattern.panels.size());
}

}  // namespace

std::string read_pattern_json(std::string_view bytes) {
  return refusal([&] { sew_and_check(parse_pattern(bytes, "pattern.json")); });
}

std::string read_dxf(std::string_view bytes) {
  return refusal([&] { sew_and_check(parse_pattern_dxf(bytes, "pattern.dxf")); });
}

}  // namespace icloth::fuzz
