// Streams: what the host has told the device to do, in order.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace cuda_on_host {

/// One thing to do: a launch, a copy, a library call, the recording of an event.
struct Operation {
  std::uint64_t number = 0;  ///< ascending over all streams
  const char* name = "";
  std::function<void()> run;
};

/// Does its operations in order: at once, or with settings().deferred when somebody waits.
struct Stream {
  std::deque<Operation> waiting;
};

struct Event {
  Stream* stream = nullptr;  ///< where it was recorded last; null: never
  std::uint64_t number = 0;  ///< of that operation
  std::shared_ptr<double> time = std::make_shared<double>(0);  ///< when it was reached [ms]
};

/// Held by every call of the runtime: host threads use the device one after another.
std::recursive_mutex& device_mutex();
using DeviceLock = std::lock_guard<std::recursive_mutex>;

/// The stream itself, the default one for null.
Stream& stream_or_default(Stream* stream);

Stream* create_stream();
void destroy_stream(Stream* stream);

/// Hands something to the device. `name` must live as long as the program. Returns its number.
std::uint64_t enqueue(Stream* stream, const char* name, std::function<void()> run);

/// Returns when the stream has done everything up to the operation with this number.
inline constexpr std::uint64_t kEverything = ~std::uint64_t{0};
void wait_for(Stream& stream, std::uint64_t number = kEverything);
void wait_for_all_streams();

}  // namespace cuda_on_host
