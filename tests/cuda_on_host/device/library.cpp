#include "tests/cuda_on_host/library.h"

#include <cstring>
#include <utility>

#include "tests/cuda_on_host/device/counts.h"
#include "tests/cuda_on_host/device/memory.h"
#include "tests/cuda_on_host/device/streams.h"

namespace cuda_on_host {

void library_call(Stream* stream, const char* name, std::function<void()> run) {
  const DeviceLock lock(device_mutex());
  ++counts().library_calls;
  enqueue(stream, name, std::move(run));
}

int toss() {
  const DeviceLock lock(device_mutex());
  return static_cast<int>(random_number() & 1);
}

void poison(void* memory, std::size_t bytes) { std::memset(memory, settings().poison, bytes); }

TemporaryStorage::TemporaryStorage(void* storage, std::size_t& bytes)
    : asked(storage == nullptr), memory(storage) {
  if (asked)
    bytes = kBytes;
  else if (bytes < kBytes)
    complain("temporary storage of %zu bytes, %zu were asked for", bytes, kBytes);
  else
    require_device("temporary storage", storage, kBytes);
}

}  // namespace cuda_on_host
