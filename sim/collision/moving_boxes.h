// Boxes of elements at both ends of straight paths.
#pragma once

#include "kernels/bvh.h"

namespace icloth::ICLOTH_BUILD {

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

ICLOTH_HD inline bool overlap(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return false;
  return true;
}

/// Whether an axis separates two elements at the start and, on the same side, at the end.
/// Coordinates are linear in time, so that the two never meet in between: layers that move together
/// stay apart, although the boxes of their whole motions overlap.
ICLOTH_HD inline bool stay_apart(const MovingBox& p, const MovingBoxes& others, Index other) {
  const Box &q0 = others.start[other], &q1 = others.end[other];
  bool apart = false;
  for (int k = 0; k < 3; ++k) {
    const bool above = (p.start.lo[k] > q0.hi[k]) & (p.end.lo[k] > q1.hi[k]);
    const bool below = (q0.lo[k] > p.start.hi[k]) & (q1.lo[k] > p.end.hi[k]);
    apart = apart | above | below;
  }
  return apart;
}

}  // namespace icloth::ICLOTH_BUILD
