// icloth pattern: what a sewing pattern holds.
#pragma once

#include <string>

namespace icloth {

struct PatternOptions {
  std::string file;  ///< pattern that docs/patterns.md describes
  std::string svg;   ///< drawing to write; empty: none
};

/// Prints the panels and the stitches, then the notes, and draws the pattern where that is asked
/// for. Returns 0. Throws InputError.
int run_pattern(const PatternOptions& options);

}  // namespace icloth
