// The primitive by which a solver copies its positions for a reader on the same device.
#pragma once

#include <memory>

#include "kernels/device_positions.h"
#include "kernels/parallel/array.h"
#if defined(__CUDACC__)
#include "kernels/device_positions_cuda.h"
#endif

namespace icloth::ICLOTH_BUILD {

/// Makes `slot` a copy of `x` in device memory, ordered behind the work that the device already
/// has. The memory of an earlier call is used again. Builds without a device leave `slot` empty.
/// Errors of the device are never thrown; DevicePositions::failure says them.
inline void copy_to_device(View<const Vec3<Real>> x, std::unique_ptr<DevicePositions>& slot) {
#if defined(__CUDACC__)
  // Only the first copy into a slot makes memory, which later ones use again.
  auto* positions = dynamic_cast<CudaPositions*>(slot.get());
  if (positions == nullptr) {
    auto fresh = std::make_unique<CudaPositions>();
    positions = fresh.get();
    slot = std::move(fresh);
  }
  positions->copy(x.data(), x.size());
#else
  static_cast<void>(x);
  slot.reset();
#endif
}

}  // namespace icloth::ICLOTH_BUILD
