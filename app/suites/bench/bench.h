// icloth bench: benchmark suites.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Runs a suite on every build that this machine has and prints a table. Returns 0, or 1 when a run
/// was refused or left penetrations. Throws InputError.
int run_bench(const BenchOptions& options);

}  // namespace icloth
