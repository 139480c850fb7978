// Runs a launch: its blocks one after another or by turns, the threads of each as fibers.
#pragma once

#include <functional>

#include "tests/cuda_on_host/launch.h"

namespace cuda_on_host {

/// Returns when all threads have ended. Complains about barriers at which not all threads of a
/// block meet, or not all blocks of a grid.
void run_grid(const LaunchShape& shape, bool cooperative, const std::function<void()>& body);

}  // namespace cuda_on_host
