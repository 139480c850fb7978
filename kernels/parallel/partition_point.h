// Bisection over a range of indices.
#pragma once

#include "kernels/parallel/platform.h"

namespace icloth::ICLOTH_BUILD {

/// The smallest i of 0 … n for which holds(i) is not true, where all true ones come before the
/// false ones.
template <class P>
ICLOTH_HD Index partition_point(Index n, const P& holds) {
  Index low = 0, high = n;
  while (low < high) {
    const Index middle = low + (high - low) / 2;
    if (holds(middle))
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

}  // namespace icloth::ICLOTH_BUILD
