#include "tests/cuda_on_host/launch.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstring>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/counts.h"
#include "tests/cuda_on_host/device/grid.h"
#include "tests/cuda_on_host/device/memory.h"
#include "tests/cuda_on_host/device/settings.h"
#include "tests/cuda_on_host/device/shared_memory.h"
#include "tests/cuda_on_host/device/streams.h"

namespace cuda_on_host {
namespace {

/// True where the word is an address at which the host has memory: x86-64 programs have theirs at
/// the upper end of the lower half of all addresses, or where position-independent code is loaded.
bool is_host_address(std::uint64_t word) {
  const bool program = word >= 0x550000000000 && word < 0x580000000000;
  const bool mapped = word >= 0x7a0000000000 && word < 0x800000000000;
  if (!program && !mapped) return false;
  void* const page = reinterpret_cast<void*>(word & ~std::uint64_t{4095});
  if (reachable_from_device(reinterpret_cast<void*>(word))) return false;
  unsigned char present = 0;
  return mincore(page, 4096, &present) == 0;
}

}  // namespace

Counts& counts() {
  static Counts all;
  return all;
}

unsigned most_cooperative_blocks() { return settings().processors * settings().resident; }

void check_words(const char* kernel, const void* argument, std::size_t bytes) {
  for (std::size_t k = 0; k + 8 <= bytes; k += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, static_cast<const unsigned char*>(argument) + k, sizeof word);
    if (is_host_address(word))
      complain("%s: byte %zu of an argument of %zu bytes holds an address of the host, %p", kernel,
               k, bytes, reinterpret_cast<void*>(word));
  }
}

void launch(const char* kernel, const LaunchShape& shape, bool cooperative,
            std::function<void()> body) {
  const DeviceLock lock(device_mutex());
  if (running_thread != nullptr) complain("%s: launched inside of a kernel", kernel);

  // A device refuses such launches, and so does the emulation.
  const unsigned blocks = shape.blocks.x, threads = shape.threads.x;
  const bool flat = shape.blocks.y * shape.blocks.z * shape.threads.y * shape.threads.z == 1;
  if (!flat) complain("%s: only grids in one direction are emulated", kernel);
  if (blocks == 0 || blocks > 0x7fffffffu || threads == 0 || threads > 1024)
    complain("%s: launch of %u blocks of %u threads", kernel, blocks, threads);
  if (shape.shared_bytes > kMostSharedBytes)
    complain("%s: launch with %zu bytes of shared memory", kernel, shape.shared_bytes);
  if (cooperative && blocks > most_cooperative_blocks())
    complain("%s: %u blocks that wait for each other, the device holds %u at once", kernel, blocks,
             most_cooperative_blocks());

  ++counts().launches;
  counts().cooperative += cooperative;
  enqueue(shape.stream, kernel,
          [shape, cooperative, body = std::move(body)] { run_grid(shape, cooperative, body); });
}

}  // namespace cuda_on_host
