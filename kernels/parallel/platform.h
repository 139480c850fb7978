// The few facts that the kernels need to know about the compiler that reads them.
//
// Stage sources are compiled once a build (cpu32, cpu64, cuda32), each in its own
// namespace icloth::ICLOTH_BUILD and with its own ICLOTH_REAL. Headers whose text does
// not depend on the build (vectors, geometry templates) live in plain namespace icloth.
#pragma once

#include <cstdint>

#if defined(__CUDACC__)
#define ICLOTH_HD __host__ __device__
#else
#define ICLOTH_HD
#endif

namespace icloth {

/// Index of a vertex, edge, face, pair …; 32 bits hold every mesh and list that fits in memory.
using Index = std::int32_t;

inline constexpr Index kNone = -1;

}  // namespace icloth

#if defined(ICLOTH_BUILD)
namespace icloth::ICLOTH_BUILD {
/// Floating-point type of positions, velocities, forces and matrices in this build.
using Real = ICLOTH_REAL;
}  // namespace icloth::ICLOTH_BUILD
#endif
