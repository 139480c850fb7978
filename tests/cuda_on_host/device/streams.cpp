#include "tests/cuda_on_host/device/streams.h"

#include <utility>
#include <vector>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/memory.h"
#include "tests/cuda_on_host/device/settings.h"

namespace cuda_on_host {
namespace {

/// Never destroyed: static objects of the program use the device at exit.
std::vector<Stream*>& all_streams() {
  static auto* const streams = new std::vector<Stream*>{new Stream};
  return *streams;
}

}  // namespace

std::recursive_mutex& device_mutex() {
  static auto* const mutex = new std::recursive_mutex;
  return *mutex;
}

Stream& stream_or_default(Stream* stream) {
  return stream != nullptr ? *stream : *all_streams().front();
}

Stream* create_stream() {
  all_streams().push_back(new Stream);
  return all_streams().back();
}

void destroy_stream(Stream* stream) {
  wait_for(*stream);
  std::erase(all_streams(), stream);
  delete stream;
}

std::uint64_t enqueue(Stream* stream, const char* name, std::function<void()> run) {
  static std::uint64_t last_number = 0;
  const DeviceLock lock(device_mutex());
  Stream& target = stream_or_default(stream);
  const std::uint64_t number = ++last_number;
  target.waiting.push_back({number, name, std::move(run)});
  if (!settings().deferred) wait_for(target);
  return number;
}

void wait_for(Stream& stream, std::uint64_t number) {
  const DeviceAccess access;
  while (!stream.waiting.empty() && stream.waiting.front().number <= number) {
    const Operation operation = std::move(stream.waiting.front());
    stream.waiting.pop_front();
    const char* const before = std::exchange(running_operation, operation.name);
    operation.run();
    running_operation = before;
  }
}

void wait_for_all_streams() {
  for (Stream* stream : all_streams()) wait_for(*stream);
}

}  // namespace cuda_on_host
