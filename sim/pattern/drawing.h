// A drawing of a pattern, for people who write seams.
#pragma once

#include <string>

#include "sim/pattern/pattern.h"

namespace icloth {

/// The panels side by side as an SVG, in centimetres: edges with their numbers and labels, stitched
/// edges in one colour a stitch with its number outside, names, areas and the grain. Panels are
/// drawn as they are in the file, seen from +z.
std::string pattern_svg(const Pattern& pattern);

/// Colour of a stitch, as SVG writes it; neighbouring numbers differ clearly.
std::string stitch_colour(std::size_t stitch);

}  // namespace icloth
