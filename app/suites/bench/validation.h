// icloth bench validation: mechanics against references that do not come from the simulation.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Runs the cases, prints a table, writes results.json and figures.csv where options.out names a
/// folder. Returns 0, or 1 when a comparison misses its target.
int run_validation(const BenchOptions& options);

}  // namespace icloth
