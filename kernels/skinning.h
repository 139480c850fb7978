// Linear blend skinning of one vertex, on top of morph targets.
//
// Everything is in double precision in all builds, and no function of a library is called: host and
// device get the same bits, so that the start check sees the body where the solver has it.
#pragma once

#include "kernels/affine.h"

namespace icloth {

/// A skin in arrays of the host or of the device. Each vertex has a range of weights and, where
/// there are morph targets, a range of displacements.
struct SkinArrays {
  const Vec3d* rest;          ///< in the space in which the bones take it up (V)
  const Index* weight_first;  ///< (V + 1)
  const Index* weight_bone;   ///< ascending within a vertex (weights)
  const double* weight;       ///< sums to 1 over a vertex (weights)
  const Index* morph_first;   ///< (V + 1), null where there are no morph targets
  const Index* morph_target;  ///< ascending within a vertex (displacements)
  const Vec3d* morph_delta;   ///< of the vertex when its target has the weight 1 (displacements)
};

/// The number, or the nearer end of what a coordinate may be. Clips of hostile files multiply large
/// numbers along their bones until they overflow, and no later stage expects what is not finite.
ICLOTH_HD inline double bounded_coordinate(double x) {
  constexpr double kLargest = 1e9;  // [m] as of a position in any file
  return !(x >= -kLargest) ? -kLargest : x > kLargest ? kLargest : x;
}

/// Where a vertex is when the bones are at `bone` and the morph targets have the weights `morph`.
ICLOTH_HD inline Vec3d skinned_vertex(const SkinArrays& skin, const Affine* bone,
                                      const double* morph, Index v) {
  // The morph targets change the shape that the bones take up.
  Vec3d x = skin.rest[v];
  if (skin.morph_first != nullptr)
    for (Index d = skin.morph_first[v]; d < skin.morph_first[v + 1]; ++d)
      x += morph[skin.morph_target[d]] * skin.morph_delta[d];

  // The vertex is the weighted mean of where each of its bones would take it.
  Vec3d sum;
  for (Index w = skin.weight_first[v]; w < skin.weight_first[v + 1]; ++w)
    sum += skin.weight[w] * bone[skin.weight_bone[w]](x);
  return {bounded_coordinate(sum.x), bounded_coordinate(sum.y), bounded_coordinate(sum.z)};
}

}  // namespace icloth
