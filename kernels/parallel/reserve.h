// Memory for arrays that are still to come: taken from the device at once, so that lists which grow
// in the middle of a run do not make a step wait for it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/parallel/array.h"

namespace icloth::ICLOTH_BUILD::memory {

#if defined(__CUDACC__)

/// The pool of the current device; only where there is one.
inline cudaMemPool_t pool() {
  int device = 0;
  cudaMemPool_t pool = nullptr;
  ICLOTH_CUDA_CHECK("memory pool", cudaGetDevice(&device));
  ICLOTH_CUDA_CHECK("memory pool", cudaDeviceGetDefaultMemPool(&pool, device));
  return pool;
}

/// Bytes that the pool of the current device has taken from it; 0 where there is no pool.
inline std::uint64_t reserved() {
  std::uint64_t bytes = 0;
  if (has_pool())
    ICLOTH_CUDA_CHECK("memory pool",
                      cudaMemPoolGetAttribute(pool(), cudaMemPoolAttrReservedMemCurrent, &bytes));
  return bytes;
}

/// Lets the pool take so many bytes for arrays that are still to come, and keep all it ever took.
/// When the device has less than that, arrays take what they need when they need it.
inline void reserve(std::uint64_t bytes) {
  if (!has_pool()) return;
  std::uint64_t everything = ~std::uint64_t{0};
  ICLOTH_CUDA_CHECK("memory pool",
                    cudaMemPoolSetAttribute(pool(), cudaMemPoolAttrReleaseThreshold, &everything));
  void* memory = nullptr;
  if (cudaMallocAsync(&memory, static_cast<std::size_t>(bytes), nullptr) == cudaSuccess)
    release(memory);
  else
    static_cast<void>(cudaGetLastError());
}

#else

/// Nothing is reserved: the heap of the C++ library keeps what is given back anyway.
inline std::uint64_t reserved() { return 0; }
inline void reserve(std::uint64_t) {}

#endif

}  // namespace icloth::ICLOTH_BUILD::memory
