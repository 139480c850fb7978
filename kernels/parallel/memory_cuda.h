// Memory of arrays in the CUDA build: that of the current device.
//
// It comes from the device's pool (cudaMallocAsync): memory that is given back stays there, behind
// the work that still uses it, and the next array takes it without waiting for the device, which
// cudaMalloc and cudaFree would do. Everything runs on the default stream, as the primitives do.
#pragma once

#include <cstddef>

#include "kernels/parallel/cuda_check.h"
#include "kernels/parallel/launch.h"

namespace icloth::ICLOTH_BUILD::memory {

/// Whether the device that is asked first has a pool; those of one program are taken to be alike.
inline bool has_pool() {
  static const bool answer = [] {
    int device = 0, supported = 0;
    const bool known =
        cudaGetDevice(&device) == cudaSuccess &&
        cudaDeviceGetAttribute(&supported, cudaDevAttrMemoryPoolsSupported, device) == cudaSuccess;
    return known && supported != 0;
  }();
  return answer;
}

inline void* allocate(std::size_t bytes) {
  void* memory = nullptr;
  const cudaError_t error =
      has_pool() ? cudaMallocAsync(&memory, bytes, nullptr) : cudaMalloc(&memory, bytes);
  ICLOTH_CUDA_CHECK("allocate array", error);
  return memory;
}
/// Unchecked: it runs in destructors, at program exit even after the driver has shut down.
inline void release(void* memory) noexcept {
  static_cast<void>(has_pool() ? cudaFreeAsync(memory, nullptr) : cudaFree(memory));
}

inline void copy_to_host(void* host, const void* array, std::size_t bytes) {
  ICLOTH_CUDA_CHECK("download array", cudaMemcpy(host, array, bytes, cudaMemcpyDeviceToHost));
}
inline void copy_from_host(void* array, const void* host, std::size_t bytes) {
  ICLOTH_CUDA_CHECK("upload array", cudaMemcpy(array, host, bytes, cudaMemcpyHostToDevice));
}
inline void copy(void* to, const void* from, std::size_t bytes) {
  ICLOTH_CUDA_CHECK("copy array", cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice));
}
inline void fill_bytes(void* array, int byte, std::size_t bytes) {
  ICLOTH_CUDA_CHECK("fill array", cudaMemsetAsync(array, byte, bytes));
}

template <class T>
__global__ void fill_kernel(T* array, Index n, T value) {
  const auto i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < n) array[i] = value;
}
template <class T>
void fill(T* array, Index n, T value) {
  constexpr int kThreads = 256;
  const unsigned blocks = (static_cast<unsigned>(n) + kThreads - 1) / kThreads;
  ICLOTH_LAUNCH(fill_kernel, blocks, kThreads)(array, n, value);
  ICLOTH_CUDA_CHECK("fill array", cudaGetLastError());
}

}  // namespace icloth::ICLOTH_BUILD::memory
