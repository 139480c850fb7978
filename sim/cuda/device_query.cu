// The questions of sim/cuda_devices.h to the CUDA runtime.
#include <algorithm>

#include "kernels/parallel/device.h"
#include "sim/cuda_devices.h"

namespace icloth::cuda32 {
namespace {

/// Puts the calling thread back on the device that it had.
class KeepDevice {
 public:
  KeepDevice() : known_(cudaGetDevice(&device_) == cudaSuccess) {}
  ~KeepDevice() {
    int now = 0;  // selecting a device starts it up, so only where needed
    if (known_ && cudaGetDevice(&now) == cudaSuccess && now != device_)
      static_cast<void>(cudaSetDevice(device_));
    static_cast<void>(cudaGetLastError());
  }
  KeepDevice(const KeepDevice&) = delete;
  KeepDevice& operator=(const KeepDevice&) = delete;

 private:
  int device_ = 0;
  bool known_;
};

/// Device memory that is given back also when a call throws.
class Buffer {
 public:
  explicit Buffer(std::size_t bytes) {
    ICLOTH_CUDA_CHECK("copy bandwidth", cudaMalloc(&memory_, bytes));
  }
  ~Buffer() { static_cast<void>(cudaFree(memory_)); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  void* get() const { return memory_; }

 private:
  void* memory_ = nullptr;
};

class Event {
 public:
  Event() { ICLOTH_CUDA_CHECK("copy bandwidth", cudaEventCreate(&event_)); }
  ~Event() { static_cast<void>(cudaEventDestroy(event_)); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  void record() { ICLOTH_CUDA_CHECK("copy bandwidth", cudaEventRecord(event_)); }
  /// [ms] from `start` to here; waits for it.
  double since(const Event& start) const {
    float ms = 0;
    ICLOTH_CUDA_CHECK("copy bandwidth", cudaEventSynchronize(event_));
    ICLOTH_CUDA_CHECK("copy bandwidth", cudaEventElapsedTime(&ms, start.event_, event_));
    return static_cast<double>(ms);
  }

 private:
  cudaEvent_t event_ = nullptr;
};

std::size_t free_bytes() {
  std::size_t free = 0, total = 0;
  if (cudaMemGetInfo(&free, &total) == cudaSuccess) return free;
  static_cast<void>(cudaGetLastError());
  return 0;
}

CudaDevice describe(int ordinal) {
  cudaDeviceProp properties{};
  ICLOTH_CUDA_CHECK("describe device", cudaGetDeviceProperties(&properties, ordinal));
  CudaDevice device;
  device.ordinal = ordinal;
  device.name = properties.name;
  device.capability = 10 * properties.major + properties.minor;
  device.memory = static_cast<double>(properties.totalGlobalMem);
  device.multiprocessors = properties.multiProcessorCount;
  device.l2_cache = static_cast<double>(properties.l2CacheSize);

  // Only a device that works can be asked for its free memory.
  device.problem = device_problem(ordinal);
  if (device.problem.empty()) device.free_memory = static_cast<double>(free_bytes());
  return device;
}

}  // namespace

CudaSystem query_system() {
  const KeepDevice keep;
  CudaSystem system;
  system.driver = detail::driver_version();
  system.runtime = detail::runtime_version();
  const int count = device_count(&system.problem);
  for (int ordinal = 0; ordinal < count; ++ordinal) system.devices.push_back(describe(ordinal));
  return system;
}

int count_devices(std::string* reason) { return device_count(reason); }

std::string name_of_device(int ordinal) { return device_name(ordinal); }

bool is_device_usable(int ordinal, std::string* reason) { return device_usable(reason, ordinal); }

double copy_bandwidth(int ordinal) {
  const KeepDevice keep;
  select_device(ordinal);

  // Large buffers and several copies make the caches and the time of a launch negligible.
  constexpr std::size_t kMost = std::size_t{512} << 20;  // well over every second-level cache
  constexpr int kCopies = 8;
  const std::size_t bytes = std::min(kMost, free_bytes() / 4);
  const Buffer from(bytes), to(bytes);
  ICLOTH_CUDA_CHECK("copy bandwidth", cudaMemset(from.get(), 1, bytes));
  Event start, end;

  // The best run counts, since others on the device can only slow a run down.
  double best = 0;
  for (int run = 0; run < 4; ++run) {  // the first one also wakes the device up
    start.record();
    for (int copy = 0; copy < kCopies; ++copy) {
      ICLOTH_CUDA_CHECK("copy bandwidth",
                        cudaMemcpyAsync(to.get(), from.get(), bytes, cudaMemcpyDeviceToDevice));
    }
    end.record();
    const double seconds = 1e-3 * end.since(start);
    if (seconds > 0) best = std::max(best, 2.0 * kCopies * static_cast<double>(bytes) / seconds);
  }
  return best;
}

}  // namespace icloth::cuda32
