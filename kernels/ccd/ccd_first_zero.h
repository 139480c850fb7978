// A certified lower bound of the first zero of the coplanarity cubic after a given time.
//
// Bézier clipping (Sederberg and Nishita, 1990) until the control points fall monotonically, then
// safeguarded Newton steps. Only comparisons against the error bound of the cubic certify anything;
// a badly converging step costs time.
#pragma once

#include "kernels/ccd/ccd_cubic.h"

namespace icloth {

namespace detail {

/// The extreme parameters at which the convex hull of the points (i/3, c[i]) meets `level`, where
/// c[0] lies above it; first > 1 when all points lie above. The first time at which the cubic comes
/// down to the level, if there is one, lies between them.
template <class T>
struct HullCut {
  T first, last;
};
template <class T>
ICLOTH_HD HullCut<T> cut_hull(const T* c, T level) {
  // The hull's boundary consists of segments between control points, so the extreme crossings are
  // among those of all pairs above/below.
  HullCut<T> cut{T(2), T(-1)};
  for (int i = 1; i < 4; ++i) {
    if (c[i] > level) continue;
    for (int j = 0; j < 4; ++j) {
      if (!(c[j] > level)) continue;
      const T x = (T(j) + T(i - j) * ((c[j] - level) / (c[j] - c[i]))) / T(3);
      cut.first = smaller(cut.first, x);
      cut.last = larger(cut.last, x);
    }
  }
  return cut;
}

/// Returns a time just before sign·f comes down to its error. It must fall monotonically from above
/// its error at `low` to at most its error at `high`.
template <class T>
ICLOTH_HD T monotone_zero_bound(const Bernstein3<T>& f, T sign, T low, T high) {
  T t = low;
  for (int iteration = 0; iteration < 60; ++iteration) {
    // The target is between one and two errors: still certain, and wide enough to be hit.
    const T value = sign * f(t) - T(1.5) * f.error;
    if (absolute(value) < T(0.5) * f.error) return t;

    // Newton's step is kept inside the bracket, which shrinks from the side of the sign.
    (value > T(0) ? low : high) = t;
    t = t - value / (T(3) * sign * f.slope(t));
    if (!(t > low && t < high)) t = T(0.5) * (low + high);
    if (high - low < T(16) * kRoundoff<T>) break;
  }
  return low;
}

/// True when the control points fall by more than their rounding errors, and so does the cubic.
template <class T>
ICLOTH_HD bool falls(const T* c, T noise) {
  return c[0] - c[1] > noise && c[1] - c[2] > noise && c[2] - c[3] > noise;
}

}  // namespace detail

/// Returns a time in [start, first zero of f at or after start], so that f is certainly nonzero
/// from `start` up to it. Returns kNever when f is certainly nonzero on [start,1].
template <class T>
ICLOTH_HD T first_zero_bound(const Bernstein3<T>& f, T start) {
  T t0 = start, t1 = T(1);
  for (int iteration = 0; iteration < 120; ++iteration) {
    // The cubic is looked at over the part [t0,t1] only, with a sign that makes it start above
    // zero.
    T c[4];
    f.restrict_to(t0, t1, c);
    if (!(detail::absolute(c[0]) > f.error)) return t0;
    const T sign = c[0] < T(0) ? T(-1) : T(1);
    for (T& x : c) x = sign * x;

    // A part whose control points all lie above the error holds no zero.
    if (c[1] > f.error && c[2] > f.error && c[3] > f.error) {
      if (!(t1 < T(1))) return T(kNever);
      t0 = t1;  // nothing in this part; go on with the rest
      t1 = T(1);
      continue;
    }

    // A part in which the cubic falls monotonically to a zero is left to Newton's method.
    if (!(c[3] > f.error) && detail::falls(c, f.error)) {
      return detail::monotone_zero_bound(f, sign, t0, t1);
    }

    // Any other part is cut down to where the hull of the control points meets zero. The cut is
    // taken a little wider than computed.
    const T width = t1 - t0;
    if (width < T(8) * kRoundoff<T>) return t0;
    const detail::HullCut<T> cut = detail::cut_hull(c, f.error);
    const T pad = T(32) * kRoundoff<T>;
    const T first = detail::larger(cut.first - pad, T(0));
    const T last = detail::smaller(cut.last + pad, T(1));

    // Where the cut takes away little, halving guards against slow convergence; the other half is
    // looked at when this one turns out to be empty.
    if (last < T(1)) t1 = t0 + width * last;
    t0 = t0 + width * first;
    if (last - first > T(0.6)) t1 = t0 + T(0.5) * (t1 - t0);
  }
  return t0;
}

}  // namespace icloth
