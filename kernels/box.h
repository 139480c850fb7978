// Boxes along the axes, and those of elements at both ends of straight paths.
#pragma once

#include <cfloat>

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// A box in single precision, rounded outward where it is made.
struct Box {
  float lo[3] = {FLT_MAX, FLT_MAX, FLT_MAX};
  float hi[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
};

ICLOTH_HD inline void include(Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k) {
    a.lo[k] = b.lo[k] < a.lo[k] ? b.lo[k] : a.lo[k];
    a.hi[k] = b.hi[k] > a.hi[k] ? b.hi[k] : a.hi[k];
  }
}

/// The smallest box around two points, padded; rounding goes outward.
ICLOTH_HD inline Box swept_box(Vec3r a, Vec3r b, Real pad) {
  const Real p[3] = {a.x, a.y, a.z}, q[3] = {b.x, b.y, b.z};
  Box box;
  for (int k = 0; k < 3; ++k) {
    const Real low = (p[k] < q[k] ? p[k] : q[k]) - pad, high = (p[k] > q[k] ? p[k] : q[k]) + pad;
    // Three float roundings happen at most; 4 ulp outward cover them.
    box.lo[k] = static_cast<float>(low) - 2.4e-7f * std::fabs(static_cast<float>(low)) - FLT_MIN;
    box.hi[k] = static_cast<float>(high) + 2.4e-7f * std::fabs(static_cast<float>(high)) + FLT_MIN;
  }
  return box;
}

ICLOTH_HD inline bool overlap(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return false;
  return true;
}

/// The boxes of an element at the start and at the end of a motion, in which every vertex follows a
/// straight path at constant speed.
struct MovingBox {
  Box start, end;

  /// The box of the whole motion.
  ICLOTH_HD Box swept() const {
    Box box = start;
    include(box, end);
    return box;
  }
};

ICLOTH_HD inline void include(MovingBox& a, const MovingBox& b) {
  include(a.start, b.start);
  include(a.end, b.end);
}

/// Whether an axis separates two elements at the start and, on the same side, at the end.
/// Coordinates are linear in time, so that the two never meet in between: layers that move together
/// stay apart, although the boxes of their whole motions overlap. It holds for all parts of two
/// groups of elements where it holds for their hulls.
ICLOTH_HD inline bool stay_apart(const MovingBox& p, const MovingBox& q) {
  bool apart = false;
  for (int k = 0; k < 3; ++k) {
    const bool above = (p.start.lo[k] > q.start.hi[k]) & (p.end.lo[k] > q.end.hi[k]);
    const bool below = (q.start.lo[k] > p.start.hi[k]) & (q.end.lo[k] > p.end.hi[k]);
    apart = apart | above | below;
  }
  return apart;
}

/// The boxes of the elements of one kind.
struct MovingBoxes {
  View<const Box> start, end;

  ICLOTH_HD Index size() const { return end.size(); }
  ICLOTH_HD MovingBoxes sub(Index first, Index count) const {
    return {start.sub(first, count), end.sub(first, count)};
  }
  ICLOTH_HD MovingBox at(Index i) const { return {start[i], end[i]}; }
  /// The box of the whole motion.
  ICLOTH_HD Box operator[](Index i) const { return at(i).swept(); }
};

}  // namespace icloth::ICLOTH_BUILD
