// How often the device was asked for something, for tests that say how often is right.
#pragma once

#include <cstddef>

namespace cuda_on_host {

/// Since the program started.
struct Counts {
  long launches = 0;          ///< of kernels of the program, cooperative ones among them
  long cooperative = 0;       ///< of kernels that may wait for the whole grid
  long library_calls = 0;     ///< scans, sorts and selections
  long copies = 0;            ///< within the device, and fills
  long host_waits = 0;        ///< calls that end only when the device has: copies to the host too
  long uploads = 0;           ///< copies from the host
  long allocations = 0;       ///< cudaMalloc, and each time that the pool had too little
  long frees = 0;             ///< cudaFree of anything but null
  std::size_t pool_used = 0;  ///< bytes of arrays from the pool that live
  std::size_t pool_reserved = 0;  ///< most that it ever was: the pool keeps what it took
  long grid_barriers = 0;         ///< of all blocks of a grid together
  std::size_t shared_bytes = 0;   ///< most that a block had, static and of the launch together
};

/// Read and written under the lock of the device (device/streams.h), or while no other thread
/// works.
Counts& counts();

}  // namespace cuda_on_host
