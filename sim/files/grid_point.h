// Points on a fine grid in a plane, so that left and right are decided without rounding.
#pragma once

#include <compare>
#include <cstdint>

namespace icloth {

/// Differences of coordinates stay below 2^30, so that their products fit 64 bits.
struct GridPoint {
  std::int64_t x, y;
  auto operator<=>(const GridPoint&) const = default;
};

/// Twice the signed area of a triangle: above 0 where c is to the left of the line from a to b.
inline std::int64_t turn(GridPoint a, GridPoint b, GridPoint c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace icloth
