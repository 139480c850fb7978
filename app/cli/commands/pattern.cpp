#include "app/cli/commands/pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/files/file_io.h"
#include "sim/files/text.h"
#include "sim/pattern/drawing.h"
#include "sim/pattern/outline.h"
#include "sim/pattern/pattern_checks.h"

namespace icloth {
namespace {

void print_panels(const Pattern& pattern) {
  std::printf("%-20s %10s %10s %6s %10s  %s\n", "panel", "area cm2", "border cm", "edges",
              "bend cm", "label");
  for (const Panel& panel : pattern.panels) {
    const double bend = panel.placement.bend_radius;
    std::printf("%-20s %10.1f %10.1f %6zu %10s  %s%s\n", excerpt(panel.name).c_str(),
                1e4 * std::fabs(signed_area(panel)), 100 * perimeter(panel), panel.edges.size(),
                bend == 0 ? "flat" : rounded_text(100 * bend).c_str(), excerpt(panel.label).c_str(),
                panel.clockwise ? " (clockwise)" : "");
  }
}

/// Prints one line a stitch. Returns how many of them gather.
std::size_t print_stitches(const Pattern& pattern) {
  if (!pattern.stitches.empty())
    std::printf("\n%-50s %8s %8s %6s\n", "stitch", "cm", "cm", "ratio");
  std::size_t gathers = 0;
  for (std::size_t s = 0; s < pattern.stitches.size(); ++s) {
    const double ratio = stitch_ratio(pattern, s);
    gathers += ratio > kGatherRatio;
    std::printf("%-52s %8.2f %8.2f %6.3f%s%s\n", stitch_name(pattern, s).c_str(),
                100 * stitched_length(pattern, s, 0), 100 * stitched_length(pattern, s, 1), ratio,
                ratio > kGatherRatio ? " gather" : "",
                pattern.stitches[s].right_wrong ? " right_wrong" : "");
  }
  return gathers;
}

}  // namespace

int run_pattern(const PatternOptions& options) {
  // The drawing comes first, so that nothing is printed where it cannot be written.
  const Pattern pattern = read_pattern(options.file);
  if (!options.svg.empty()) write_file(options.svg, pattern_svg(pattern));
  print_panels(pattern);
  const std::size_t gathers = print_stitches(pattern);

  // The totals are in one line, then come the notes.
  double area = 0;
  std::size_t edges = 0;
  for (const Panel& panel : pattern.panels) {
    area += std::fabs(signed_area(panel));
    edges += panel.edges.size();
  }
  std::printf("\npanels %zu, edges %zu, stitches %zu, gathers %zu, fabric %.3f m2\n",
              pattern.panels.size(), edges, pattern.stitches.size(), gathers, area);
  for (const std::string& note : pattern.notes) std::printf("note: %s\n", note.c_str());
  return 0;
}

}  // namespace icloth
