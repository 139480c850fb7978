#include "tests/cuda_on_host/device/shared_memory.h"

#include <sys/mman.h>

#include <algorithm>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/counts.h"
#include "tests/cuda_on_host/device/race_detector.h"
#include "tests/cuda_on_host/device/settings.h"

namespace cuda_on_host {
namespace {

constexpr std::size_t kBehind = 64;  ///< bytes behind an array that must stay as they are
constexpr unsigned char kUntouched = 0xa5;

}  // namespace

SharedMemory::~SharedMemory() {
  if (memory_ != nullptr) munmap(memory_, kAllBytes);
}

void SharedMemory::begin(std::size_t bytes_of_launch) {
  // ThreadSanitizer gets other memory for every block: what the block before did is no race.
  if (memory_ != nullptr && kDetectsRaces) {
    munmap(memory_, kAllBytes);
    memory_ = nullptr;
  }
  if (memory_ == nullptr) {
    constexpr int kKind = MAP_PRIVATE | MAP_ANONYMOUS;
    void* at = mmap(nullptr, kAllBytes, PROT_READ | PROT_WRITE, kKind, -1, 0);
    if (at == MAP_FAILED) complain("no memory for the shared memory of a block");
    memory_ = static_cast<unsigned char*>(at);
  }
  declarations_.clear();
  of_launch_ = bytes_of_launch;
  fill(kDeclaredRoom, bytes_of_launch);
}

void* SharedMemory::declared(const void* key, std::size_t bytes) {
  std::size_t first = 0;
  for (const Declaration& d : declarations_) {
    if (d.key == key) return memory_ + d.first;
    first = (d.first + d.bytes + kBehind + 63) / 64 * 64;
  }
  if (first + bytes + kBehind > kDeclaredRoom) complain("more static shared memory than 64 KiB");
  declarations_.push_back({key, first, bytes});
  fill(first, bytes);
  return memory_ + first;
}

/// Poison, then the bytes behind. Byte by byte: ThreadSanitizer watches memset, and would take it
/// for a write of the thread that comes here first.
void SharedMemory::fill(std::size_t first, std::size_t bytes) const {
  volatile unsigned char* const at = memory_ + first;
  for (std::size_t k = 0; k < bytes; ++k) at[k] = settings().poison;
  for (std::size_t k = bytes; k < bytes + kBehind; ++k) at[k] = kUntouched;
}

void SharedMemory::check() const {
  std::size_t bytes = of_launch_;
  for (const Declaration& d : declarations_) {
    bytes += d.bytes;
    check_behind(d.first + d.bytes);
  }
  check_behind(kDeclaredRoom + of_launch_);
  counts().shared_bytes = std::max(counts().shared_bytes, bytes);
  if (bytes > kMostSharedBytes)
    complain("%zu bytes of shared memory, %zu of them of the launch; at most %zu are allowed",
             bytes, of_launch_, kMostSharedBytes);
}

void SharedMemory::check_behind(std::size_t end) const {
  for (std::size_t k = 0; k < kBehind; ++k)
    if (memory_[end + k] != kUntouched) complain("write behind shared memory, found later");
}

}  // namespace cuda_on_host
