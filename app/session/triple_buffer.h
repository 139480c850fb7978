// Hands whole states from one thread to another; neither side ever waits for the other's work.
#pragma once

#include <array>
#include <mutex>
#include <utility>

namespace icloth {

/// One writer fills back() and publishes it, one reader takes the newest published value. The lock
/// is held for the exchange of two indices only, and the slots' memory is used again.
template <class T>
class TripleBuffer {
 public:
  /// Writer's slot; holds an old value until it is overwritten.
  T& back() { return slots_[back_]; }

  /// Writer: makes back() the newest value.
  void publish() {
    const std::lock_guard lock(mutex_);
    std::swap(back_, ready_);
    fresh_ = true;
  }

  /// Reader: moves to the newest value; false when there is none since the last call.
  bool take() {
    const std::lock_guard lock(mutex_);
    if (!fresh_) return false;
    std::swap(front_, ready_);
    fresh_ = false;
    return true;
  }

  /// Reader's slot; stays as it is until the next take().
  const T& front() const { return slots_[front_]; }

 private:
  std::mutex mutex_;
  std::array<T, 3> slots_{};
  std::size_t back_ = 0, ready_ = 1, front_ = 2;
  bool fresh_ = false;
};

}  // namespace icloth
