// The device that a build computes on: this machine's processor, or a CUDA device.
#pragma once

#include <array>
#include <string>

#include "kernels/parallel/platform.h"

#if defined(__CUDACC__)
#include "kernels/parallel/cuda_check.h"
#include "kernels/parallel/device_problem.h"
#include "kernels/parallel/launch.h"
#endif

namespace icloth::ICLOTH_BUILD {

#if defined(__CUDACC__)

namespace detail {

/// Compute capabilities that this program was compiled for, ascending.
inline std::span<const int> built_capabilities() {
  static constexpr auto kBuilt = [] {
    std::array tenfold{__CUDA_ARCH_LIST__};  // 750, 800 …
    for (int& each : tenfold) each /= 10;
    return tenfold;
  }();
  return kBuilt;
}

inline int driver_version() {
  int version = 0;
  if (cudaDriverGetVersion(&version) != cudaSuccess) static_cast<void>(cudaGetLastError());
  return version;
}
inline int runtime_version() {
  int version = CUDART_VERSION;
  if (cudaRuntimeGetVersion(&version) != cudaSuccess) static_cast<void>(cudaGetLastError());
  return version;
}

/// Value of an attribute, or 0 where it cannot be asked for.
inline int attribute(cudaDeviceAttr which, int ordinal) {
  int value = 0;
  if (cudaDeviceGetAttribute(&value, which, ordinal) == cudaSuccess) return value;
  static_cast<void>(cudaGetLastError());
  return 0;
}

constexpr int kProbe = 20180604;
template <class = void>
__global__ void probe_kernel(int* out) {
  *out = kProbe;
}

/// Runs a kernel on the calling thread's device and reads back what it wrote.
inline cudaError_t probe() {
  int* out = nullptr;
  int value = 0;
  cudaError_t error = cudaMalloc(&out, sizeof value);
  if (error != cudaSuccess) return error;
  ICLOTH_LAUNCH(probe_kernel<>, 1, 1)(out);  // fails where no code for this capability was built
  error = cudaGetLastError();
  if (error == cudaSuccess) error = cudaMemcpy(&value, out, sizeof value, cudaMemcpyDeviceToHost);
  if (error == cudaSuccess && value != kProbe) error = cudaErrorUnknown;
  static_cast<void>(cudaFree(out));
  return error;
}

}  // namespace detail

/// Number of devices that the driver shows; 0 without a driver (`reason`, if given, then says why).
inline int device_count(std::string* reason = nullptr) {
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error == cudaSuccess && count > 0) return count;
  static_cast<void>(cudaGetLastError());  // clears it
  if (reason != nullptr) {
    *reason = no_device_problem(detail::driver_version(), detail::runtime_version(),
                                cudaGetErrorString(error ? error : cudaErrorNoDevice));
  }
  return 0;
}

inline std::string device_name(int ordinal) {
  cudaDeviceProp properties{};
  ICLOTH_CUDA_CHECK("device_name", cudaGetDeviceProperties(&properties, ordinal));
  return properties.name;
}

/// Compute capability as 10 · major + minor.
inline int device_capability(int ordinal) {
  return 10 * detail::attribute(cudaDevAttrComputeCapabilityMajor, ordinal) +
         detail::attribute(cudaDevAttrComputeCapabilityMinor, ordinal);
}

/// Makes the device that of the calling thread. Throws std::runtime_error.
inline void select_device(int ordinal) {
  ICLOTH_CUDA_CHECK("select_device", cudaSetDevice(ordinal));
}

/// Waits for all work handed to the device of the calling thread.
inline void device_synchronize() {
  ICLOTH_CUDA_CHECK("device_synchronize", cudaDeviceSynchronize());
}

/// Says in one line why this program's kernels cannot run on the device; empty means that they can.
/// Leaves the device selected for the calling thread where that is possible.
inline std::string device_problem(int ordinal) {
  // Without a driver, or with too few devices, nothing else can be asked.
  std::string reason;
  const int count = device_count(&reason);
  if (count == 0) return reason;
  if (ordinal < 0 || ordinal >= count) return no_such_device_problem(ordinal, count);

  // The properties of the device tell what it can never do.
  const std::string name = device_name(ordinal);
  const auto no_code = [&] {
    return no_code_problem(ordinal, name, device_capability(ordinal), detail::built_capabilities(),
                           detail::runtime_version());
  };
  if (device_capability(ordinal) < detail::built_capabilities().front()) return no_code();
  if (detail::attribute(cudaDevAttrComputeMode, ordinal) == cudaComputeModeProhibited)
    return device_text(ordinal, name) + " is in compute mode 'prohibited'";
  if (detail::attribute(cudaDevAttrCooperativeLaunch, ordinal) == 0)
    return device_text(ordinal, name) + " cannot launch cooperative kernels, which are needed";

  // A trial launch shows what the properties do not, such as missing code for a newer device.
  cudaError_t error = cudaSetDevice(ordinal);
  if (error == cudaSuccess) error = detail::probe();
  if (error == cudaSuccess) return "";
  static_cast<void>(cudaGetLastError());
  if (error == cudaErrorNoKernelImageForDevice) return no_code();
  return device_text(ordinal, name) + ": " + cudaGetErrorString(error);
}

/// True when there is no device_problem; otherwise `reason` (may be null) gets its text.
inline bool device_usable(std::string* reason = nullptr, int ordinal = 0) {
  const std::string problem = device_problem(ordinal);
  if (reason != nullptr) *reason = problem;
  return problem.empty();
}

#else

inline int device_count(std::string* = nullptr) { return 1; }
inline std::string device_name(int) { return "cpu"; }
inline void select_device(int) {}
inline void device_synchronize() {}
inline bool device_usable(std::string* = nullptr, int = 0) { return true; }

#endif

}  // namespace icloth::ICLOTH_BUILD
