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
#pragma once

#include "kernels/vec.h"

namespace icloth {

/// The three vectors whose determinant is the volume, at t = 0 and t = 1.
/// vf: the two edges of the face from v0, and vertex − v0. ee: both edges, and b0 − a0.
template <class T>
struct VolumeVectors {
  Vec3<T> b0, c0, p0, b1, c1, p1;
};

/// Coefficients A, 3 k1, 3 k2, B and the bounds of their rounding errors.
template <class T>
struct VolumeCubic {
  T a{}, k1x3{}, k2x3{}, b{};
  T error_ends{}, error_inner{};

  /// All four coefficients have one certain sign: f has no zero in [0,1]. False for NaN.
  ICLOTH_HD bool certainly_nonzero() const {
    return (a > error_ends && b > error_ends && k1x3 > error_inner && k2x3 > error_inner) ||
           (a < -error_ends && b < -error_ends && k1x3 < -error_inner && k2x3 < -error_inner);
  }
};

/// Half the distance from 1 to the next number: the largest relative rounding error.
template <class T>
inline constexpr T kRoundoff = sizeof(T) == 4 ? T(0x1p-24) : T(0x1p-53);

template <class T>
ICLOTH_HD VolumeCubic<T> volume_cubic(const VolumeVectors<T>& v) {
  // Below this floor products may underflow; raising a factor only widens the bound.
  const T floor = sizeof(T) == 4 ? T(1e-10) : T(1e-90);
  const T size_b = std::fmax(std::fmax(norm_max(v.b0), norm_max(v.b1)), floor);
  const T size_c = std::fmax(std::fmax(norm_max(v.c0), norm_max(v.c1)), floor);
  const T size_p = std::fmax(std::fmax(norm_max(v.p0), norm_max(v.p1)), floor);
  const T unit = kRoundoff<T> * (size_b * size_c * size_p);
  const Vec3<T> n0 = cross(v.b0, v.c0), n1 = cross(v.b1, v.c1);
  const Vec3<T> m = cross(v.b0, v.c1) + cross(v.b1, v.c0);
  return {dot(n0, v.p0),
          dot(m, v.p0) + dot(n0, v.p1),
          dot(m, v.p1) + dot(n1, v.p0),
          dot(n1, v.p1),
          T(48) * unit,
          T(170) * unit};
}

/// Bernstein coefficients and the bound within which the computed cubic, evaluated in fp64
/// anywhere in [0,1], agrees with the true volume.
struct Bernstein3 {
  double c[4];
  double error;

  ICLOTH_HD explicit Bernstein3(const VolumeCubic<double>& f)
      : c{f.a, f.k1x3 / 3, f.k2x3 / 3, f.b} {
    // 170/3 u S of the coefficients; 32 u max|c| for the division, for three rounds of linear
    // interpolation (9 u) and for parameters that are off by one rounding (|f'| ≤ 6 max|c|).
    const double largest = std::fmax(std::fmax(std::fabs(c[0]), std::fabs(c[1])),
                                     std::fmax(std::fabs(c[2]), std::fabs(c[3])));
    error = f.error_inner / 3 + 32 * kRoundoff<double> * largest;
  }

  /// All coefficients vanish within the error: coplanar throughout as far as fp64 can tell.
  ICLOTH_HD bool vanishes() const {
    return std::fabs(c[0]) <= error && std::fabs(c[1]) <= error && std::fabs(c[2]) <= error &&
           std::fabs(c[3]) <= error;
  }

  ICLOTH_HD double operator()(double t) const {
    const double s = 1 - t;
    const double x = s * c[0] + t * c[1], y = s * c[1] + t * c[2], z = s * c[2] + t * c[3];
    return s * (s * x + t * y) + t * (s * y + t * z);
  }

  /// Coefficients over the interval [t0,t1] (polar form), into out[4].
  ICLOTH_HD void restrict_to(double t0, double t1, double* out) const {
    const double s0 = 1 - t0, s1 = 1 - t1;
    const double x0 = s0 * c[0] + t0 * c[1], y0 = s0 * c[1] + t0 * c[2], z0 = s0 * c[2] + t0 * c[3];
    const double x1 = s1 * c[0] + t1 * c[1], y1 = s1 * c[1] + t1 * c[2], z1 = s1 * c[2] + t1 * c[3];
    const double p00 = s0 * x0 + t0 * y0, q00 = s0 * y0 + t0 * z0;
    const double p01 = s1 * x0 + t1 * y0, q01 = s1 * y0 + t1 * z0;
    const double p11 = s1 * x1 + t1 * y1, q11 = s1 * y1 + t1 * z1;
    out[0] = s0 * p00 + t0 * q00;
    out[1] = s1 * p00 + t1 * q00;
    out[2] = s1 * p01 + t1 * q01;
    out[3] = s1 * p11 + t1 * q11;
  }
};

namespace detail {

/// Extreme parameters at which the convex hull of the points (i/3, c[i]) meets `level`, c[0] being
/// above it; first > 1 when all points lie above. The first time that the cubic comes down to the
/// level, if there is one, lies between.
struct HullCut {
  double first, last;
};
ICLOTH_HD inline HullCut cut_hull(const double* c, double level) {
  // The hull's boundary consists of segments between control points, so the extreme crossings are
  // among those of all pairs above/below.
  HullCut cut{2, -1};
  for (int i = 1; i < 4; ++i) {
    if (c[i] > level) continue;
    for (int j = 0; j < 4; ++j) {
      if (!(c[j] > level)) continue;
      const double x = (j + (i - j) * ((c[j] - level) / (c[j] - c[i]))) / 3;
      cut.first = std::fmin(cut.first, x);
      cut.last = std::fmax(cut.last, x);
    }
  }
  return cut;
}

}  // namespace detail

inline constexpr double kNever = 2;

/// A time in [start, first zero of f at or after start]: f is certainly nonzero from `start` up to
/// it. kNever when f is certainly nonzero on [start,1]. Bézier clipping, with halving as the
/// fallback.
ICLOTH_HD inline double first_zero_bound(const Bernstein3& f, double start) {
  double t0 = start, t1 = 1;
  for (int iteration = 0; iteration < 80; ++iteration) {
    double c[4];
    f.restrict_to(t0, t1, c);
    if (!(std::fabs(c[0]) > f.error)) return t0;
    if (c[0] < 0) {
      for (double& x : c) x = -x;
    }
    const detail::HullCut cut = detail::cut_hull(c, f.error);
    const double width = t1 - t0;
    if (cut.first > 1) {  // nothing in this part; go on with the rest
      if (t1 >= 1) return kNever;
      t0 = t1;
      t1 = 1;
      continue;
    }
    if (width < 0x1p-50) return t0;
    // The cut is taken a little wider than computed: 2⁻⁴⁸ of the interval.
    const double first = std::fmax(cut.first - 0x1p-48, 0.0),
                 last = std::fmin(cut.last + 0x1p-48, 1.0);
    t1 = last < 1 ? t0 + width * last : t1;
    t0 += width * first;
    if (last - first > 0.6) t1 = t0 + 0.5 * (t1 - t0);
  }
  return t0;
}

}  // namespace icloth
