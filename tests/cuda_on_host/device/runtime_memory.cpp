// The functions of the CUDA runtime: memory and copies.
#include <vector>

#include "cuda_runtime.h"
#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/counts.h"
#include "tests/cuda_on_host/device/errors.h"
#include "tests/cuda_on_host/device/memory.h"
#include "tests/cuda_on_host/device/settings.h"
#include "tests/cuda_on_host/device/streams.h"

using cuda_on_host::complain;
using cuda_on_host::counts;
using cuda_on_host::device_mutex;
using cuda_on_host::DeviceLock;

cudaError_t cuda_on_host::allocate(void** memory, std::size_t bytes) {
  const DeviceLock lock(device_mutex());
  ++counts().allocations;
  *memory = bytes > 0 ? allocate_device(bytes) : nullptr;
  return *memory != nullptr || bytes == 0 ? cudaSuccess : fail(cudaErrorMemoryAllocation);
}

/// Waits for the whole device first, as CUDA does.
cudaError_t cudaFree(void* memory) {
  if (memory == nullptr) return cudaSuccess;
  const DeviceLock lock(device_mutex());
  ++counts().frees;
  cuda_on_host::wait_for_all_streams();
  cuda_on_host::free_device(memory);
  return cudaSuccess;
}

// ---- the pool -----------------------------------------------------------------------------------

// Every array has pages of its own here too, so that access beside it is seen; the pool is only
// counted. It takes from the device what it does not have, and holds back nothing to fill gaps.

cudaError_t cuda_on_host::allocate_from_pool(void** memory, std::size_t bytes) {
  const DeviceLock lock(device_mutex());
  *memory = bytes > 0 ? allocate_device(bytes) : nullptr;
  if (*memory == nullptr) return bytes == 0 ? cudaSuccess : fail(cudaErrorMemoryAllocation);
  counts().pool_used += bytes;
  if (counts().pool_used > counts().pool_reserved) {
    counts().pool_reserved = counts().pool_used;
    ++counts().allocations;
  }
  return cudaSuccess;
}

/// The memory lives until the stream has come here.
cudaError_t cudaFreeAsync(void* memory, cudaStream_t stream) {
  if (memory == nullptr) return cudaSuccess;
  const DeviceLock lock(device_mutex());
  cuda_on_host::enqueue(stream, "cudaFreeAsync",
                        [memory] { counts().pool_used -= cuda_on_host::free_device(memory); });
  return cudaSuccess;
}

cudaError_t cudaDeviceGetDefaultMemPool(cudaMemPool_t* pool, int) {
  *pool = nullptr;
  return cudaSuccess;
}
cudaError_t cudaMemPoolSetAttribute(cudaMemPool_t, cudaMemPoolAttr, void*) { return cudaSuccess; }
cudaError_t cudaMemPoolGetAttribute(cudaMemPool_t, cudaMemPoolAttr which, void* value) {
  const DeviceLock lock(device_mutex());
  if (which != cudaMemPoolAttrReservedMemCurrent) return cuda_on_host::fail(cudaErrorNotSupported);
  const std::uint64_t bytes = counts().pool_reserved;
  std::memcpy(value, &bytes, sizeof bytes);
  return cudaSuccess;
}

// ---- copies -------------------------------------------------------------------------------------

cudaError_t cudaHostAlloc(void** memory, std::size_t bytes, unsigned) {
  const DeviceLock lock(device_mutex());
  *memory = cuda_on_host::allocate_pinned(bytes);
  return *memory != nullptr ? cudaSuccess : cuda_on_host::fail(cudaErrorMemoryAllocation);
}
cudaError_t cudaFreeHost(void* memory) {
  const DeviceLock lock(device_mutex());
  cuda_on_host::wait_for_all_streams();
  cuda_on_host::free_pinned(memory);
  return cudaSuccess;
}
cudaError_t cudaHostGetDevicePointer(void** on_device, void* on_host, unsigned) {
  *on_device = on_host;
  return cudaSuccess;
}

namespace {

void download(void* to, const void* from, std::size_t bytes) {
  ++counts().host_waits;
  cuda_on_host::wait_for(cuda_on_host::stream_or_default(nullptr));
  cuda_on_host::require_device("copy to the host: from", from, bytes);
  cuda_on_host::require_host("copy to the host: to", to, bytes);
  const cuda_on_host::DeviceAccess access;
  std::memcpy(to, from, bytes);
}

/// The host's content is taken now: CUDA too stages what is not pinned before it returns.
void upload(void* to, const void* from, std::size_t bytes) {
  ++counts().uploads;
  cuda_on_host::require_device("copy to the device: to", to, bytes);
  cuda_on_host::require_host("copy to the device: from", from, bytes);
  const auto* first = static_cast<const unsigned char*>(from);
  cuda_on_host::enqueue(nullptr, "copy to the device",
                        [to, staged = std::vector<unsigned char>(first, first + bytes)] {
                          std::memcpy(to, staged.data(), staged.size());
                        });
}

}  // namespace

cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  const DeviceLock lock(device_mutex());
  if (bytes == 0) return cudaSuccess;
  switch (kind) {
    case cudaMemcpyDeviceToHost:
      download(to, from, bytes);
      return cudaSuccess;
    case cudaMemcpyHostToDevice:
      upload(to, from, bytes);
      return cudaSuccess;
    default:
      complain("cudaMemcpy of this kind is not emulated");
  }
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream) {
  const DeviceLock lock(device_mutex());
  ++counts().copies;
  if (bytes == 0) return cudaSuccess;
  if (kind != cudaMemcpyDeviceToDevice) complain("cudaMemcpyAsync of this kind is not emulated");
  cuda_on_host::require_device("copy on the device: to", to, bytes);
  cuda_on_host::require_device("copy on the device: from", from, bytes);
  const auto *t = static_cast<const char*>(to), *f = static_cast<const char*>(from);
  if (f < t + bytes && t < f + bytes) complain("copy on the device: the two ranges overlap");
  cuda_on_host::enqueue(stream, "copy on the device", [=] { std::memcpy(to, from, bytes); });
  return cudaSuccess;
}

cudaError_t cudaMemsetAsync(void* to, int byte, std::size_t bytes, cudaStream_t stream) {
  const DeviceLock lock(device_mutex());
  ++counts().copies;
  cuda_on_host::require_device("cudaMemset", to, bytes);
  cuda_on_host::enqueue(stream, "cudaMemset", [=] { std::memset(to, byte, bytes); });
  return cudaSuccess;
}
cudaError_t cudaMemset(void* to, int byte, std::size_t bytes) {
  return cudaMemsetAsync(to, byte, bytes, nullptr);
}
