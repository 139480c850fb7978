// icloth bench stability: the hard cases, one row each.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Runs the cases that --case names (all by default) and prints a table; the requirements that a
/// case misses are printed below its row. Returns 0, or 1 when a case fails.
int run_stability(const BenchOptions& options);

}  // namespace icloth
