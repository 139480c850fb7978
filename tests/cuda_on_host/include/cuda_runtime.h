// Stands in for the CUDA runtime's header: the part of it that the program uses, and the words of
// nvcc's language. What the functions do is in ../device/; what is missing here is not used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "tests/cuda_on_host/kernel.h"
#include "tests/cuda_on_host/launch.h"

// ---- the language -------------------------------------------------------------------------------

#define __host__
#define __device__
#define __global__
#define __launch_bounds__(...)
#define threadIdx (::cuda_on_host::running_thread->index)
#define blockIdx (::cuda_on_host::running_thread->block->index)
#define blockDim (::cuda_on_host::running_thread->block->dim)
#define gridDim (::cuda_on_host::running_thread->block->grid)

// See kernels/parallel/launch.h.
#define ICLOTH_LAUNCH(kernel, ...)                                                                \
  ::cuda_on_host::Launcher {                                                                      \
#kernel, [](const auto&... arguments_) { kernel(arguments_...); },                            \
                                                                    ::cuda_on_host::LaunchShape { \
      __VA_ARGS__                                                                                 \
    }                                                                                             \
  }
#define ICLOTH_SHARED(name, bytes)   \
  static const char name##_key_ = 0; \
  unsigned char* const name =        \
      static_cast<unsigned char*>(::cuda_on_host::shared_memory(&name##_key_, bytes))
#define ICLOTH_SHARED_OF_LAUNCH(name) \
  unsigned char* const name = ::cuda_on_host::shared_memory_of_launch()

inline void __syncthreads(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  ::cuda_on_host::block_barrier(file, line);
}
inline void __threadfence() { ::cuda_on_host::memory_fence(); }
inline unsigned atomicInc(unsigned* at, unsigned most) {
  return ::cuda_on_host::atomic_increment(at, most);
}
inline double __dmul_rn(double a, double b) { return a * b; }
inline int __ffs(int bits) { return __builtin_ffs(bits); }

// ---- errors -------------------------------------------------------------------------------------

#define CUDART_VERSION 13000

enum cudaError_t {
  cudaSuccess = 0,
  cudaErrorInvalidValue = 1,
  cudaErrorMemoryAllocation = 2,
  cudaErrorNoDevice = 100,
  cudaErrorInvalidDevice = 101,
  cudaErrorNoKernelImageForDevice = 209,
  cudaErrorNotSupported = 801,
  cudaErrorUnknown = 999
};
cudaError_t cudaGetLastError();
const char* cudaGetErrorString(cudaError_t error);
const char* cudaGetErrorName(cudaError_t error);

// ---- devices ------------------------------------------------------------------------------------

enum cudaDeviceAttr {
  cudaDevAttrMultiProcessorCount = 16,
  cudaDevAttrComputeMode = 20,
  cudaDevAttrComputeCapabilityMajor = 75,
  cudaDevAttrComputeCapabilityMinor = 76,
  cudaDevAttrCooperativeLaunch = 95,
  cudaDevAttrMemoryPoolsSupported = 115
};
enum { cudaComputeModeProhibited = 2 };
struct cudaDeviceProp {
  char name[256];
  int major, minor, multiProcessorCount, l2CacheSize;
  std::size_t totalGlobalMem;
};
cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaGetDevice(int* device);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device);
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr which, int device);
cudaError_t cudaDriverGetVersion(int* version);
cudaError_t cudaRuntimeGetVersion(int* version);
cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total);
cudaError_t cudaDeviceSynchronize();

// ---- memory -------------------------------------------------------------------------------------

enum cudaMemcpyKind {
  cudaMemcpyHostToHost,
  cudaMemcpyHostToDevice,
  cudaMemcpyDeviceToHost,
  cudaMemcpyDeviceToDevice
};
enum { cudaHostAllocMapped = 2 };
using cudaStream_t = ::cuda_on_host::Stream*;
namespace cuda_on_host {
cudaError_t allocate(void** memory, std::size_t bytes);
}
template <class T>
cudaError_t cudaMalloc(T** memory, std::size_t bytes) {
  return ::cuda_on_host::allocate(reinterpret_cast<void**>(memory), bytes);
}
cudaError_t cudaFree(void* memory);
cudaError_t cudaHostAlloc(void** memory, std::size_t bytes, unsigned flags);
cudaError_t cudaFreeHost(void* memory);
cudaError_t cudaHostGetDevicePointer(void** on_device, void* on_host, unsigned flags);
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream = nullptr);
cudaError_t cudaMemset(void* to, int byte, std::size_t bytes);
cudaError_t cudaMemsetAsync(void* to, int byte, std::size_t bytes, cudaStream_t stream = nullptr);

// Memory that is allocated and given back in the order of a stream, from a pool that the device
// has.
using cudaMemPool_t = struct EmulatedPool*;
enum cudaMemPoolAttr { cudaMemPoolAttrReleaseThreshold = 4, cudaMemPoolAttrReservedMemCurrent = 5 };
namespace cuda_on_host {
cudaError_t allocate_from_pool(void** memory, std::size_t bytes);
}
template <class T>
cudaError_t cudaMallocAsync(T** memory, std::size_t bytes, cudaStream_t) {
  return ::cuda_on_host::allocate_from_pool(reinterpret_cast<void**>(memory), bytes);
}
cudaError_t cudaFreeAsync(void* memory, cudaStream_t stream);
cudaError_t cudaDeviceGetDefaultMemPool(cudaMemPool_t* pool, int device);
cudaError_t cudaMemPoolSetAttribute(cudaMemPool_t pool, cudaMemPoolAttr which, void* value);
cudaError_t cudaMemPoolGetAttribute(cudaMemPool_t pool, cudaMemPoolAttr which, void* value);

// ---- streams and events -------------------------------------------------------------------------

namespace cuda_on_host {
struct Event;
}
using cudaEvent_t = ::cuda_on_host::Event*;
enum { cudaStreamNonBlocking = 1, cudaEventDisableTiming = 2 };
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags = 0);
cudaError_t cudaEventCreate(cudaEvent_t* event);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned flags);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream = nullptr);
cudaError_t cudaEventSynchronize(cudaEvent_t event);
cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t start, cudaEvent_t end);

// ---- cooperative launches -----------------------------------------------------------------------

namespace cuda_on_host {
int resident_blocks_per_processor();
}
template <class Kernel>
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, Kernel, int, std::size_t) {
  *blocks = ::cuda_on_host::resident_blocks_per_processor();
  return cudaSuccess;
}
template <class... Arguments>
cudaError_t cudaLaunchCooperativeKernel(void (*kernel)(Arguments...), dim3 blocks, dim3 threads,
                                        void** arguments, std::size_t shared_bytes = 0,
                                        cudaStream_t stream = nullptr) {
  ::cuda_on_host::launch_cooperative(kernel, {blocks, threads, shared_bytes, stream}, arguments,
                                     std::index_sequence_for<Arguments...>{});
  return cudaSuccess;
}
