// Helpers that the stand-ins of CUDA's libraries share.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/settings.h"

namespace cuda_on_host {

struct Stream;

/// Hands a library call to the device, and counts it.
void library_call(Stream* stream, const char* name, std::function<void()> run);

/// 0 or 1, at random.
int toss();

/// Fills device memory that holds nothing now.
void poison(void* memory, std::size_t bytes);

/// The temporary storage of a library call: with null it is asked how many bytes it takes.
struct TemporaryStorage {
  bool asked;
  void* memory;

  TemporaryStorage(void* storage, std::size_t& bytes);
  /// The call uses all of it.
  void overwrite() const { poison(memory, kBytes); }

 private:
  static constexpr std::size_t kBytes = 1000;  // no multiple of anything
};

/// f(0) … f(n − 1), called in the order of the settings.
template <class F>
std::vector<bool> in_any_order(int n, const F& f) {
  std::vector<bool> found(static_cast<std::size_t>(n));
  const auto start = static_cast<std::int64_t>(random_number() >> 1);
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<int>(nth(n, k, start));
    found[static_cast<std::size_t>(i)] = f(i);
  }
  return found;
}

}  // namespace cuda_on_host
