// icloth bench scaling: how time and memory of the stages grow with the number of triangles.
#pragma once

#include "app/suites/bench/bench_options.h"

namespace icloth {

/// Runs one scene with contact at sizes from 10K to 1M triangles, times --scale, prints times,
/// exponents and floors, and writes the report where --out says. A signal ends it with what has
/// been measured by then. Returns 0, or 1 when it was ended, a step was refused or penetrations
/// were accepted.
int run_scaling(const BenchOptions& options);

}  // namespace icloth
