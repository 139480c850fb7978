// The coplanarity cubic of four linearly moving points: coefficients with a proved error bound,
// and a lower bound of its first zero.
//
// f(t) = det(b(t), c(t), p(t)) with b, c, p linear in t is a cubic; its Bernstein coefficients are
//   A = n0·p0,  k1 = (m·p0 + n0·p1)/3,  k2 = (m·p1 + n1·p0)/3,  B = n1·p1
// with n0 = b0×c0, n1 = b1×c1, m = b0×c1 + b1×c0 (Tang et al., "Fast and exact continuous collision
// detection with Bernstein sign classification", 2014, state them in another arrangement).
//
// Rounding: each entry of b, c, p is one difference of stored numbers, so it carries a relative
// error u; following the products term by term the errors are at most 48 u S for A and B and
// 170 u S for 3 k1 and 3 k2, S = |b||c||p| with |·| the largest component at either end. (Cross
// product 8 u |b||c|, m 20 u |b||c|, then the two dot products and the sum; contraction to fused
// multiply-adds only lowers it.) Underflow is covered by a floor under the three factors.
//
// T is float (in the filter), double or DoubleDouble.
#pragma once

#include "kernels/ccd/double_double.h"
#include "kernels/vec.h"

namespace icloth {

/// A time after the end, which stands for "does not happen in [0,1]".
inline constexpr double kNever = 2;

/// Bound of the relative error of one operation.
template <class T>
inline constexpr T kRoundoff{};
template <>
inline constexpr float kRoundoff<float> = 0x1p-24f;
template <>
inline constexpr double kRoundoff<double> = 0x1p-53;
template <>
inline constexpr DoubleDouble kRoundoff<DoubleDouble> = DoubleDouble(0x1p-102);

namespace detail {

template <class T>
ICLOTH_HD T smaller(T a, T b) {
  return b < a ? b : a;
}
template <class T>
ICLOTH_HD T larger(T a, T b) {
  return a < b ? b : a;
}
template <class T>
ICLOTH_HD T absolute(T a) {
  return a < T(0) ? -a : a;
}
template <class T>
ICLOTH_HD T largest_component(Vec3<T> a, Vec3<T> b) {
  const T x = larger(absolute(a.x), absolute(b.x)), y = larger(absolute(a.y), absolute(b.y));
  return larger(larger(x, y), larger(absolute(a.z), absolute(b.z)));
}

}  // namespace detail

/// The three vectors whose determinant is the volume, at t = 0 and t = 1. For vf they are the two
/// edges of the face from v0, and vertex − v0. For ee they are both edges, and b0 − a0.
template <class T>
struct VolumeVectors {
  Vec3<T> b0, c0, p0, b1, c1, p1;
};

/// Coefficients A, 3 k1, 3 k2, B and the bounds of their rounding errors.
template <class T>
struct VolumeCubic {
  T a{}, k1x3{}, k2x3{}, b{};
  T error_ends{}, error_inner{};

  /// True when all four coefficients certainly have one sign, so that f has no zero in [0,1]. False
  /// for NaN.
  ICLOTH_HD bool certainly_nonzero() const {
    return (a > error_ends && b > error_ends && k1x3 > error_inner && k2x3 > error_inner) ||
           (a < -error_ends && b < -error_ends && k1x3 < -error_inner && k2x3 < -error_inner);
  }
};

/// The coefficients of the cubic, and the error bounds that the head of this file derives.
template <class T>
ICLOTH_HD VolumeCubic<T> volume_cubic(const VolumeVectors<T>& v) {
  // Below this floor products may underflow; raising a factor only widens the bound.
  const T floor = sizeof(T) == 4 ? T(1e-10) : T(1e-60);
  const T size_b = detail::larger(detail::largest_component(v.b0, v.b1), floor);
  const T size_c = detail::larger(detail::largest_component(v.c0, v.c1), floor);
  const T size_p = detail::larger(detail::largest_component(v.p0, v.p1), floor);
  const T unit = kRoundoff<T> * (size_b * size_c * size_p);

  // The coefficients are those of the head of this file, the inner two times 3 to save a division.
  const Vec3<T> n0 = cross(v.b0, v.c0), n1 = cross(v.b1, v.c1);
  const Vec3<T> m = cross(v.b0, v.c1) + cross(v.b1, v.c0);
  return {dot(n0, v.p0),
          dot(m, v.p0) + dot(n0, v.p1),
          dot(m, v.p1) + dot(n1, v.p0),
          dot(n1, v.p1),
          T(48) * unit,
          T(170) * unit};
}

/// Bernstein coefficients, and the bound within which the computed cubic, evaluated in T anywhere
/// in [0,1], agrees with the true volume.
template <class T>
struct Bernstein3 {
  T c[4];
  T error;

  ICLOTH_HD explicit Bernstein3(const VolumeCubic<T>& f)
      : c{f.a, f.k1x3 / T(3), f.k2x3 / T(3), f.b} {
    // The bound is 170/3 u S of the coefficients plus 32 u max|c|, which covers the division, three
    // rounds of linear interpolation (9 u), 1 − t (3 u) and times off by one rounding (|f'| ≤ 6
    // max|c|).
    const T ends = detail::larger(detail::absolute(c[0]), detail::absolute(c[3]));
    const T inner = detail::larger(detail::absolute(c[1]), detail::absolute(c[2]));
    error = f.error_inner / T(3) + T(32) * kRoundoff<T> * detail::larger(ends, inner);
  }

  /// True when all coefficients vanish within the error: the points are coplanar throughout as far
  /// as T can tell.
  ICLOTH_HD bool vanishes() const {
    for (T x : c) {
      if (detail::absolute(x) > error) return false;
    }
    return true;
  }

  /// The value at t, by de Casteljau's scheme.
  ICLOTH_HD T operator()(T t) const {
    const T s = T(1) - t;
    const T x = s * c[0] + t * c[1], y = s * c[1] + t * c[2], z = s * c[2] + t * c[3];
    return s * (s * x + t * y) + t * (s * y + t * z);
  }

  /// The sign of the true value at t where it is certain, else 0.
  ICLOTH_HD double certain_sign(T t) const {
    const T value = (*this)(t);
    return value > error ? 1 : value < -error ? -1 : 0;
  }

  /// A third of the derivative at t.
  ICLOTH_HD T slope(T t) const {
    const T s = T(1) - t, x = c[1] - c[0], y = c[2] - c[1], z = c[3] - c[2];
    return s * (s * x + t * y) + t * (s * y + t * z);
  }

  /// Writes the coefficients over the interval [t0,t1] into out[4]. They are the polar form of the
  /// cubic at the combinations of t0 and t1.
  ICLOTH_HD void restrict_to(T t0, T t1, T* out) const {
    // x, y and z are the first round of interpolation at either end of the interval.
    const T s0 = T(1) - t0, s1 = T(1) - t1;
    const T x0 = s0 * c[0] + t0 * c[1], y0 = s0 * c[1] + t0 * c[2], z0 = s0 * c[2] + t0 * c[3];
    const T x1 = s1 * c[0] + t1 * c[1], y1 = s1 * c[1] + t1 * c[2], z1 = s1 * c[2] + t1 * c[3];

    // p and q are the second round; the digits say at which ends the two rounds were evaluated.
    const T p00 = s0 * x0 + t0 * y0, q00 = s0 * y0 + t0 * z0;
    const T p01 = s1 * x0 + t1 * y0, q01 = s1 * y0 + t1 * z0;
    const T p11 = s1 * x1 + t1 * y1, q11 = s1 * y1 + t1 * z1;
    out[0] = s0 * p00 + t0 * q00;
    out[1] = s1 * p00 + t1 * q00;
    out[2] = s1 * p01 + t1 * q01;
    out[3] = s1 * p11 + t1 * q11;
  }
};

}  // namespace icloth
