// Whether a pattern can be sewn.
#pragma once

#include <string>

#include "sim/pattern/pattern.h"

namespace icloth {

/// Area below which a panel is refused [m²].
inline constexpr double kSmallestPanel = 1e-4;

/// Distance from the origin of a panel that no point of it exceeds [m]; differences then fit the
/// grid.
inline constexpr double kLargestReach = 50;

/// Lengths of two stitched edges, the longer one over the shorter one, above this: a gather.
inline constexpr double kGatherRatio = 1.03;

/// Ratio of the lengths of two stitched edges above which a mistake is likely.
inline constexpr double kLikelyMistakeRatio = 4;

/// Checks what a reader has read. Throws InputError for a loop that is not closed, an outline that
/// crosses itself, and a panel without area. What can be sewn and yet looks wrong is added to the
/// notes. Sets Panel::clockwise.
void check_pattern(Pattern& pattern);

/// Length of one of the two edges of a stitch [m].
double stitched_length(const Pattern& pattern, std::size_t stitch, std::size_t side);

/// The longer edge of a stitch over the shorter one.
double stitch_ratio(const Pattern& pattern, std::size_t stitch);

/// "stitch 3 (front:1 – back:7)"
std::string stitch_name(const Pattern& pattern, std::size_t stitch);

}  // namespace icloth
