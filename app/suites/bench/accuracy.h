// icloth bench accuracy: speed against error, with the cost and the error of each setting.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Sweeps the settings on small versions of four scenes against a reference in double precision
/// with a sixteenth of the time step. Returns 1 when a run was refused or left penetrations.
int run_accuracy(const BenchOptions& options);

}  // namespace icloth
