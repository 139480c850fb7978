// icloth bench paper: the comparisons of Tang et al. 2018, Section 5, with this program's modes.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Runs all comparisons on the CPU (or the device that was asked for), prints their tables, and
/// writes the report where --out says. Returns 0, or 1 when a state with penetrations was accepted.
int run_paper(const BenchOptions& options);

}  // namespace icloth
