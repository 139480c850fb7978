// The emulation of <<<…>>> and of the cooperative launch: arguments are copied as bytes, and the
// stream gets the kernel.
#pragma once

#include <cstddef>
#include <functional>
#include <tuple>
#include <type_traits>
#include <utility>

#include "tests/cuda_on_host/kernel.h"

namespace cuda_on_host {

struct Stream;

/// The launch configuration between <<< and >>>.
struct LaunchShape {
  dim3 blocks, threads;
  std::size_t shared_bytes = 0;
  Stream* stream = nullptr;
};

/// Complains about shapes that a device refuses; else puts the launch into its stream. `kernel` is
/// the name, `body` calls it for the running thread; `cooperative`: it may wait for the whole grid.
void launch(const char* kernel, const LaunchShape& shape, bool cooperative,
            std::function<void()> body);

/// Blocks that can wait for each other: all that the device holds at once.
unsigned most_cooperative_blocks();

/// Complains about words that are addresses of host memory, which a device cannot reach.
void check_words(const char* kernel, const void* argument, std::size_t bytes);

/// The same for an argument of a kernel. What lies between its members is left out: there may be
/// anything, old addresses too.
template <class Argument>
void check_argument(const char* kernel, const Argument& argument) {
  Argument copy = argument;
#if defined(__GNUC__) && !defined(__clang__)
  __builtin_clear_padding(&copy);
  check_words(kernel, &copy, sizeof copy);
#else
  static_cast<void>(kernel);  // this compiler cannot tell
#endif
}

inline constexpr std::size_t kMostArgumentBytes = 4096;

template <class Kernel, class... Arguments>
void launch_with(const char* name, const LaunchShape& shape, bool cooperative, const Kernel& kernel,
                 const Arguments&... arguments) {
  static_assert((std::is_trivially_copyable_v<Arguments> && ...), "arguments are copied as bytes");
  static_assert((sizeof(Arguments) + ... + 0) <= kMostArgumentBytes, "too many arguments");
  (check_argument(name, arguments), ...);
  launch(name, shape, cooperative,
         [kernel, copies = std::make_tuple(arguments...)] { std::apply(kernel, copies); });
}

/// The object that ICLOTH_LAUNCH makes. It is called with the arguments of the kernel.
template <class Kernel>
struct Launcher {
  const char* name;
  Kernel kernel;
  LaunchShape shape;

  template <class... Arguments>
  void operator()(const Arguments&... arguments) const {
    launch_with(name, shape, false, kernel, arguments...);
  }
};
template <class Kernel>
Launcher(const char*, Kernel, LaunchShape) -> Launcher<Kernel>;

/// `arguments`: addresses of the arguments.
template <class... Arguments, std::size_t... I>
void launch_cooperative(void (*kernel)(Arguments...), const LaunchShape& shape, void** arguments,
                        std::index_sequence<I...>) {
  launch_with("cooperative kernel", shape, true, kernel,
              *static_cast<std::remove_const_t<Arguments>*>(arguments[I])...);
}

}  // namespace cuda_on_host
