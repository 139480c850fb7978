// All collisions of a mesh between two frames, by the broad phase and exact elementary tests,
// without a simulation around them. It is built from the stages in double precision.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

struct Collisions {
  std::vector<std::array<Index, 2>> vertex_face;  ///< (vertex, face), ascending
  std::vector<std::array<Index, 4>> edge_edge;    ///< vertices a0 < a1, b0 < b1; a1 ≤ b1
  std::int64_t candidates = 0;                    ///< pairs that the broad phase left
  double ms_broad_phase = 0, ms_ccd = 0;          ///< [ms]
};

namespace cpu64 {
/// Finds the vertex–face and edge–edge pairs that touch at some time while every vertex moves
/// straight from `start` to `end` (V each) [any unit]. Pairs that share a vertex are left out. The
/// indices must be in range.
Collisions detect_collisions(std::span<const Vec3d> start, std::span<const Vec3d> end,
                             std::span<const Triangle> faces);
}  // namespace cpu64

}  // namespace icloth
