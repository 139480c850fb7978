// Four numbers that are loaded, multiplied and added together: a vector register on the CPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "kernels/parallel/platform.h"

namespace icloth::ICLOTH_BUILD {

#if defined(__CUDACC__)
struct Lanes {
  Real v[4];
  ICLOTH_HD Real operator[](int k) const { return v[k]; }
};
ICLOTH_HD inline Lanes operator*(Lanes a, Lanes b) {
  return {{a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]}};
}
ICLOTH_HD inline Lanes operator*(Lanes a, Real s) {
  return {{a.v[0] * s, a.v[1] * s, a.v[2] * s, a.v[3] * s}};
}
ICLOTH_HD inline Lanes operator+(Lanes a, Lanes b) {
  return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
ICLOTH_HD inline Lanes& operator+=(Lanes& a, Lanes b) { return a = a + b; }
#else
// The vector type is written out because compilers drop a lane that is not used and then shuffle
// the other three.
using Lanes = Real __attribute__((vector_size(4 * sizeof(Real))));
#endif

/// Prefetches memory that is read soon, `ahead` numbers from `from`. Beyond the end of the memory
/// it does no harm.
ICLOTH_HD inline void prefetch([[maybe_unused]] const Real* from,
                               [[maybe_unused]] std::ptrdiff_t ahead) {
#if !defined(__CUDACC__)
  const auto address =
      reinterpret_cast<std::uintptr_t>(from) + static_cast<std::uintptr_t>(ahead) * sizeof(Real);
  __builtin_prefetch(reinterpret_cast<const void*>(address));
#endif
}

/// Reads four numbers from any address.
ICLOTH_HD inline Lanes load_lanes(const Real* from) {
  Lanes a;
  memcpy(&a, from, sizeof a);
  return a;
}

}  // namespace icloth::ICLOTH_BUILD
