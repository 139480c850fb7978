// icloth bench quick: two scenes, a minute.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Steps a second, times of the stages and peak memory of two scenes. Returns 0, or 1 when a run
/// was refused or left penetrations. Throws InputError.
int run_quick(const BenchOptions& options);

}  // namespace icloth
