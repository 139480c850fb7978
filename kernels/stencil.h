// Small index and weight records that the stages pass around.
#pragma once

#include "kernels/parallel/array.h"
#include "kernels/vec.h"

namespace icloth::ICLOTH_BUILD {

using Vec3r = Vec3<Real>;
using Mat3r = Mat3<Real>;

struct Int2 {
  Index v[2];
};
struct Int3 {
  Index v[3];
};
struct Int4 {
  Index v[4];
};

/// Two elements: (vertex, face) or (edge, edge) with the smaller edge first.
struct Pair {
  Index a, b;
};

/// A linear functional g(x) = Σ w_a x_{v_a} of four vertices, such as the gap vector of a VF or EE
/// pair. Vertices ≥ cloth_vertices belong to obstacles.
struct Stencil {
  Index v[4];
  Real w[4];
};

/// The value Σ w_a field[v_a].
ICLOTH_HD inline Vec3r apply(const Stencil& s, View<const Vec3r> field) {
  Vec3r sum{};
  for (int a = 0; a < 4; ++a) sum += s.w[a] * field[s.v[a]];
  return sum;
}

/// A key of a pair that sorts VF before EE, then by element numbers; there are at most 2³¹ elements
/// each.
ICLOTH_HD inline std::uint64_t pair_key(bool edge_edge, Pair pair) {
  return (static_cast<std::uint64_t>(edge_edge) << 63) |
         (static_cast<std::uint64_t>(pair.a) << 31) | static_cast<std::uint64_t>(pair.b);
}
ICLOTH_HD inline bool key_is_edge_edge(std::uint64_t key) { return (key >> 63) != 0; }
ICLOTH_HD inline Pair key_pair(std::uint64_t key) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 31) - 1;
  return {static_cast<Index>((key >> 31) & mask), static_cast<Index>(key & mask)};
}

}  // namespace icloth::ICLOTH_BUILD
