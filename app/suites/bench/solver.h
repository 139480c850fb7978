// icloth bench solver: the preconditioners of the implicit step compared on the same states.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Prints a table and, with --out, writes the report. Returns 0. Throws InputError.
int run_solver(const BenchOptions& options);

}  // namespace icloth
