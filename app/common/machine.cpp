#include "app/common/machine.h"

#include <icloth_commit.h>
#include <malloc.h>
#include <sys/resource.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "kernels/parallel/parallel_for.h"
#include "sim/cuda_devices.h"

namespace icloth {

std::string program_version() { return ICLOTH_VERSION; }
std::string program_commit() { return ICLOTH_COMMIT; }

std::string compiler_name() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__ + ", " ICLOTH_BUILD_TYPE;
#else
  return std::string("g++ ") + __VERSION__ + ", " ICLOTH_BUILD_TYPE;
#endif
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

int processor_threads() { return tbb::info::default_concurrency(); }

double memory_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

double peak_memory_bytes() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (double kib = 0; word == "VmHWM:" && file >> kib) return 1024.0 * kib;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void reset_peak_memory() {
  // Memory that is free, but still held for later, would count as used.
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5";
}

double measure_memory_bandwidth() {
  // Three arrays that exceed every cache are added up in blocks.
  constexpr std::size_t count = std::size_t{1} << 24;  // 128 MiB an array
  constexpr std::size_t block = std::size_t{1} << 16;
  const auto a = std::make_unique_for_overwrite<double[]>(count);
  const auto b = std::make_unique<double[]>(count), c = std::make_unique<double[]>(count);

  // The first of the runs brings in the pages.
  double best = 0;
  for (int run = 0; run < 6; ++run) {
    const auto start = std::chrono::steady_clock::now();
    parallel_for(Index{count / block}, 2, 1, [&](Index first, Index last) {
      for (std::size_t i = block * static_cast<std::size_t>(first);
           i < block * static_cast<std::size_t>(last); ++i)
        a[i] = b[i] + 3.0 * c[i];
    });
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    best = std::max(best, 3.0 * sizeof(double) * count / time.count());
  }
  return best;
}

ComputeDevice compute_device(Build build) {
  if (build != Build::cuda32 || !build_available(build)) return {};
  ComputeDevice device;
  device.name = cuda_device_name(cuda_device());

  // A device whose memory is full still computes, so its bandwidth stays unknown.
  try {
    device.copy_bandwidth = measure_copy_bandwidth(cuda_device());
  } catch (const std::runtime_error&) {
    // A device whose memory is full still computes.
  }
  return device;
}

}  // namespace icloth
