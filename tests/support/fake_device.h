// A device for drawing that is none: its memory is the host's. Shows what happens around interop
// on machines without CUDA.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/device_positions.h"

namespace icloth::testing {

struct FakeDevicePositions : DevicePositions {
  void assign(const std::vector<Vec3f>& positions) {
    memory = positions;
    data = memory.data();
    count = static_cast<Index>(memory.size());
  }
  std::vector<Vec3f> memory;
};

/// Copies as Simulator::positions_on_device does: the slot's memory is used again.
inline void fake_copy_to_device(const std::vector<Vec3f>& positions,
                                std::unique_ptr<DevicePositions>& slot) {
  if (!slot) slot = std::make_unique<FakeDevicePositions>();
  static_cast<FakeDevicePositions&>(*slot).assign(positions);
}

}  // namespace icloth::testing
