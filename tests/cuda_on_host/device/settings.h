// How the emulated device behaves: in which order it works and what it watches.
#pragma once

#include <cstdint>

namespace cuda_on_host {

/// In which order the threads of a block run between two barriers, and the blocks of a launch. A
/// correct kernel gives the same result in each.
enum class Order { forward, backward, random };

/// Read from the environment at the first use; a test may change them between two launches.
struct Settings {
  Order order = Order::forward;  ///< CUDA_ON_HOST_ORDER=forward|backward|random
  std::uint64_t seed = 1;        ///< CUDA_ON_HOST_SEED: of all that is random here
  unsigned turns = 4;            ///< CUDA_ON_HOST_TURNS: blocks that take turns, in random order
  unsigned devices = 0;          ///< CUDA_ON_HOST_DEVICES=1: the device is there
  unsigned processors = 3;       ///< CUDA_ON_HOST_PROCESSORS: multiprocessors of the device
  unsigned resident = 2;         ///< CUDA_ON_HOST_RESIDENT: blocks that each of them holds at once
  unsigned char poison = 0xcb;   ///< CUDA_ON_HOST_POISON: every byte of fresh memory
  bool deferred = false;         ///< CUDA_ON_HOST_DEFERRED=1: nothing runs before the host waits
  bool guarded = false;          ///< CUDA_ON_HOST_GUARDED=1: the host cannot touch device memory
};

Settings& settings();

/// Next number of a well-mixed sequence that starts at settings().seed.
std::uint64_t random_number();

/// The i-th of n in the order of the settings. Random: from a random place on, round to it.
std::int64_t nth(std::int64_t n, std::int64_t i, std::int64_t start);

}  // namespace cuda_on_host
