// Numbers of elements on the host, where containers count in std::size_t.
#pragma once

#include <cstddef>

#include "kernels/parallel/platform.h"

namespace icloth {

/// The place of element i in a container. `list[at(i)]` says that i is known not to be negative.
constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace icloth
