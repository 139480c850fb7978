// The angle of a vector in the plane, with the same bits on the CPU and on a CUDA device.
#pragma once

#include <cmath>

#include "kernels/parallel/platform.h"

namespace icloth {

/// Returns atan2(y, x). In double precision the function of the library serves.
ICLOTH_HD inline double angle_of(double y, double x) { return std::atan2(y, x); }

/// Returns atan2(y, x) in single precision, from operations that IEEE 754 rounds alike everywhere.
/// The functions of the libraries differ in their last bits between CPU and CUDA, and contacts let
/// such a difference grow to millimetres within tens of steps. The error is below 3 ulp; the null
/// vector gives 0, and two infinite arguments give NaN.
ICLOTH_HD inline float angle_of(float y, float x) {
  constexpr float kPi = 3.14159265358979f;

  // The angle is first computed for the octant 0 … π/4, from the ratio of the smaller coordinate to
  // the larger one.
  const float ax = std::fabs(x), ay = std::fabs(y);
  const bool steep = ay > ax;
  const float low = steep ? ax : ay, high = steep ? ay : ax;
  if (high == 0) return 0;

  // The identity atan(t) = π/4 + atan((t − 1)/(t + 1)) halves the range further, to |u| ≤ tan(π/8).
  const bool wide = low > 0.41421356f * high;
  const float u = wide ? (low - high) / (low + high) : low / high;

  // The minimax polynomial of (atan(u)/u − 1)/u² in u² over that range has a relative error of
  // 2e-8.
  const float z = u * u;
  const float p = ((0.08060309f * z - 0.1387985f) * z + 0.19977926f) * z - 0.33332955f;
  float angle = u + u * (z * p);

  // The symmetries of the circle lead back from the octant to the whole plane; a NaN passes
  // through.
  if (wide) angle += kPi / 4;
  if (steep) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : (y == y ? angle : y);
}

}  // namespace icloth
