// Positions that the solver leaves for a reader on its own device, without copying them to the
// host.
#pragma once

#include <string>

#include "kernels/vec.h"

namespace icloth {

/// A copy of the positions of all vertices in memory of a CUDA device. The solver's thread fills
/// it, then another thread draws from it; who has it at a time is up to them (a slot of a triple
/// buffer). The work on the device goes on meanwhile, so the device waits by two events: a reader
/// lets its stream wait for `written` and records `read` behind its last access, and the next copy
/// into the same memory waits for `read`.
struct DevicePositions {
  DevicePositions() = default;
  virtual ~DevicePositions() = default;
  DevicePositions(const DevicePositions&) = delete;
  DevicePositions& operator=(const DevicePositions&) = delete;

  int device = 0;               ///< CUDA ordinal in this process
  const Vec3f* data = nullptr;  ///< device memory: x y z tightly packed [m] (count)
  Index count = 0;              ///< vertices, in the order of the world
  void* written = nullptr;      ///< cudaEvent_t
  void* read = nullptr;         ///< cudaEvent_t
  std::string failure;          ///< why the copy could not be made, one line; empty: it was
};

}  // namespace icloth
