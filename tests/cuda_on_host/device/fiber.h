// A fiber: code on a stack of its own, which can be left in the middle and gone on with later.
#pragma once

#include <cstddef>

namespace cuda_on_host {

/// Only one fiber runs at a time, and only the scheduler (code outside all fibers) enters one.
class Fiber {
 public:
  /// Calls main(argument) at the first `enter`; it must never return.
  Fiber(void (*main)(void*), void* argument);
  ~Fiber();
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  /// Goes on with the fiber until it leaves.
  void enter();
  /// Goes back to where the fiber was entered. Called inside of it.
  void leave();

 private:
  static constexpr std::size_t kStackBytes = 512 << 10;

  unsigned char* stack_ = nullptr;  ///< its lowest page cannot be touched
  void* own_top_ = nullptr;         ///< of the stack, while the fiber is not running
  void* scheduler_top_ = nullptr;   ///< of the scheduler's stack, while the fiber is running
  void* own_identity_ = nullptr;    ///< what ThreadSanitizer knows it as
  void* scheduler_identity_ = nullptr;
};

}  // namespace cuda_on_host
