// Boxes along the axes, around the points of a mesh.
#pragma once

#include <algorithm>
#include <limits>

#include "kernels/vec.h"

namespace icloth {

/// A box along the axes; at first it is empty, holds nothing and overlaps nothing.
struct Box {
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Vec3d low{kInfinite, kInfinite, kInfinite}, high{-kInfinite, -kInfinite, -kInfinite};

  void add(const Box& b) {
    low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
    high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
  }
  void add(Vec3d p) { add(Box{p, p}); }

  bool empty() const { return low.x > high.x; }
  Vec3d size() const { return high - low; }
  /// The same box, larger by `reach` on every side.
  Box grown(double reach) const {
    const Vec3d r{reach, reach, reach};
    return {low - r, high + r};
  }
  bool overlaps(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
};

/// The smallest box around points in a range.
template <class Points>
Box box_around(const Points& points) {
  Box box;
  for (const Vec3d p : points) box.add(p);
  return box;
}

}  // namespace icloth
