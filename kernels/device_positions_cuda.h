// Positions for a reader on a CUDA device: memory, events and the copy.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>

#include "kernels/device_positions.h"

namespace icloth {

static_assert(sizeof(Vec3f) == 3 * sizeof(float), "readers expect tightly packed floats");

/// It never throws: an error of the device is said in `failure`, and the reader copies over the
/// host instead. Memory and events are made by the first copy and kept.
class CudaPositions final : public DevicePositions {
 public:
  /// Errors are not looked at here, since it runs at program exit even after the driver has shut
  /// down.
  ~CudaPositions() override { release(); }

  /// Copies `n` positions from memory of the calling thread's device, behind all work that the
  /// device's default stream has, and returns without waiting.
  void copy(const Vec3f* from, Index n) {
    failure.clear();
    const std::size_t bytes = static_cast<std::size_t>(n) * sizeof(Vec3f);
    const bool copied =
        prepare(n) && works(cudaStreamWaitEvent(nullptr, static_cast<cudaEvent_t>(read), 0)) &&
        works(cudaMemcpyAsync(memory_, from, bytes, cudaMemcpyDeviceToDevice, nullptr)) &&
        works(cudaEventRecord(static_cast<cudaEvent_t>(written), nullptr));
    data = copied ? memory_ : nullptr;
    count = copied ? n : 0;
  }

 private:
  /// Makes memory for `n` positions and the two events, where those of the last copy do not serve.
  bool prepare(Index n) {
    int current = 0;
    if (!works(cudaGetDevice(&current))) return false;
    if (read != nullptr && capacity_ >= n && device == current) return true;
    release();
    device = current;
    void* memory = nullptr;
    if (!works(cudaMalloc(&memory, static_cast<std::size_t>(n > 0 ? n : 1) * sizeof(Vec3f))))
      return false;
    memory_ = static_cast<Vec3f*>(memory);
    capacity_ = n;
    return make_event(written) && make_event(read);  // `read` is last: all is there with it
  }

  bool make_event(void*& out) {
    cudaEvent_t event = nullptr;
    if (!works(cudaEventCreateWithFlags(&event, cudaEventDisableTiming))) return false;
    out = event;
    return true;
  }

  /// Waits for the reader first: its kernel may still be at work.
  void release() noexcept {
    if (read != nullptr) static_cast<void>(cudaEventSynchronize(static_cast<cudaEvent_t>(read)));
    for (void** event : {&written, &read}) {
      if (*event != nullptr) static_cast<void>(cudaEventDestroy(static_cast<cudaEvent_t>(*event)));
      *event = nullptr;
    }
    if (memory_ != nullptr) static_cast<void>(cudaFree(memory_));
    memory_ = nullptr;
    capacity_ = 0;
    static_cast<void>(cudaGetLastError());  // a later check must not report what happened here
  }

  bool works(cudaError_t error) {
    if (error == cudaSuccess) return true;
    static_cast<void>(cudaGetLastError());
    failure = std::string("CUDA: ") + cudaGetErrorString(error);
    return false;
  }

  Vec3f* memory_ = nullptr;
  Index capacity_ = 0;
};

}  // namespace icloth
