// Stands in for CUDA's header: only the barrier of the whole grid.
#pragma once

#include "tests/cuda_on_host/kernel.h"

namespace cooperative_groups {

struct grid_group {
  void sync(const char* file = __builtin_FILE(), int line = __builtin_LINE()) const {
    ::cuda_on_host::grid_barrier(file, line);
  }
};
inline grid_group this_grid() { return {}; }

}  // namespace cooperative_groups
