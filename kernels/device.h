// The device that a build computes on: this machine's processor, or a CUDA device.
#pragma once

#include <string>

#include "kernels/platform.h"

#if defined(__CUDACC__)
#include "kernels/cuda_check.h"
#endif

namespace icloth::ICLOTH_BUILD {

#if defined(__CUDACC__)

/// Devices that the driver shows; 0 without a driver (`reason`, if given, then says why).
inline int device_count(std::string* reason = nullptr) {
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess) {
    static_cast<void>(cudaGetLastError());  // clears it
    if (reason != nullptr) *reason = cudaGetErrorString(error);
    return 0;
  }
  if (count == 0 && reason != nullptr) *reason = "the driver shows no device";
  return count;
}

inline std::string device_name(int ordinal) {
  cudaDeviceProp properties{};
  ICLOTH_CUDA_CHECK("device_name", cudaGetDeviceProperties(&properties, ordinal));
  return properties.name;
}

/// Makes the device that of the calling thread. Throws std::runtime_error.
inline void select_device(int ordinal) {
  ICLOTH_CUDA_CHECK("select_device", cudaSetDevice(ordinal));
}

/// Waits for all work handed to the device of the calling thread.
inline void device_synchronize() {
  ICLOTH_CUDA_CHECK("device_synchronize", cudaDeviceSynchronize());
}

namespace detail {
template <class = void>
__global__ void probe_kernel() {}
}  // namespace detail

/// Whether this program's kernels run on the device; if not, `reason` (may be null) says why.
/// Selects the device for the calling thread.
inline bool device_usable(std::string* reason = nullptr, int ordinal = 0) {
  const int count = device_count(reason);
  if (count == 0) return false;
  if (ordinal < 0 || ordinal >= count) {
    if (reason != nullptr) *reason = "there are " + std::to_string(count) + " CUDA devices";
    return false;
  }
  cudaError_t error = cudaSetDevice(ordinal);
  if (error == cudaSuccess) {
    detail::probe_kernel<><<<1, 1>>>();  // fails where no code for this architecture was built
    error = cudaGetLastError();
  }
  if (error == cudaSuccess) error = cudaDeviceSynchronize();
  if (error != cudaSuccess && reason != nullptr) *reason = cudaGetErrorString(error);
  return error == cudaSuccess;
}

#else

inline int device_count(std::string* = nullptr) { return 1; }
inline std::string device_name(int) { return "cpu"; }
inline void select_device(int) {}
inline void device_synchronize() {}
inline bool device_usable(std::string* = nullptr, int = 0) { return true; }

#endif

}  // namespace icloth::ICLOTH_BUILD
