// The device as a kernel sees it: its place in the grid, barriers, shared memory.
#pragma once

#include <cstddef>

struct dim3 {
  unsigned x = 1, y = 1, z = 1;
  constexpr dim3(unsigned x_ = 1, unsigned y_ = 1, unsigned z_ = 1) : x(x_), y(y_), z(z_) {}
};
struct uint3 {
  unsigned x, y, z;
};

namespace cuda_on_host {

/// Place of a block.
struct BlockPlace {
  uint3 index{};   ///< blockIdx
  dim3 dim, grid;  ///< blockDim, gridDim
};

/// Place of a thread.
struct ThreadPlace {
  uint3 index{};  ///< threadIdx
  const BlockPlace* block = nullptr;
};

/// The thread of the device that runs now; null while host code runs.
extern ThreadPlace* running_thread;

/// Waits for all threads of the block, or of the grid. File and line tell barriers apart: all must
/// wait at the same one.
void block_barrier(const char* file, int line);
void grid_barrier(const char* file, int line);
/// Orders the memory accesses of this thread for others that meet it at another fence.
void memory_fence();

/// Shared memory of the running block: `key` is the address of something that stands for the
/// declaration. Fresh memory is poisoned.
void* shared_memory(const void* key, std::size_t bytes);
/// The bytes that the launch asked for.
unsigned char* shared_memory_of_launch();

/// *at becomes old + 1, or 0 where old ≥ most; returns old.
unsigned atomic_increment(unsigned* at, unsigned most);

}  // namespace cuda_on_host
