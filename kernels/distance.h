// The closest points of a point and a triangle, and of two segments, in 3D.
//
// Robust in the sense that every answer is a pair of points of the two primitives and that its
// distance is the smallest of all stationary candidates: the interior solution is only trusted
// when it lies inside, and the boundary is searched whenever that solution is ill-conditioned.
// Degenerate triangles (needles, points), parallel segments and segments of length 0 are allowed.
#pragma once

#include "kernels/vec.h"

namespace icloth {

/// Closest point Σ w_k x_k of a triangle; the weights lie in [0,1] and sum to 1 up to rounding.
template <class T>
struct TrianglePoint {
  T w[3]{};
  T distance2{};         // squared distance [length²]
  bool interior{false};  // the projection of the point falls strictly inside the face
};

/// Closest points a0 + s (a1 − a0) and b0 + t (b1 − b0) of two segments, s and t in [0,1].
template <class T>
struct SegmentPoints {
  T s{}, t{};
  T distance2{};         // squared distance [length²]
  bool interior{false};  // 0 < s < 1 and 0 < t < 1
};

/// Parameter in [0,1] of the point of the segment a0 a1 that is closest to p.
template <class T>
ICLOTH_HD T closest_on_segment(Vec3<T> p, Vec3<T> a0, Vec3<T> a1) {
  const Vec3<T> e = a1 - a0;
  const T along = dot(p - a0, e), length2 = norm2(e);
  if (!(along > T(0))) return T(0);  // also for a segment of length 0
  return along < length2 ? along / length2 : T(1);
}

/// Below this squared sine the interior solution has lost too many digits to be trusted alone.
template <class T>
inline constexpr T kIllConditioned2 = sizeof(T) == 4 ? T(1e-4) : T(1e-8);

namespace detail {

/// Replaces `best` by the closest point of the edge x0 x1 where that is closer.
template <class T>
ICLOTH_HD void keep_closer(TrianglePoint<T>& best, Vec3<T> p, Vec3<T> x0, Vec3<T> x1, int k0,
                           int k1) {
  const T s = closest_on_segment(p, x0, x1);
  const T d2 = norm2((T(1) - s) * (x0 - p) + s * (x1 - p));
  if (!(d2 < best.distance2)) return;
  best = {};
  best.w[k0] = T(1) - s;
  best.w[k1] = s;
  best.distance2 = d2;
}

/// Replaces `best` by the given points of the two segments where those are closer.
template <class T>
ICLOTH_HD void keep_closer(SegmentPoints<T>& best, Vec3<T> gap, T s, T t) {
  const T d2 = norm2(gap);
  if (d2 < best.distance2) best = {s, t, d2, false};
}

}  // namespace detail

/// What a search is for. Most pairs that are looked at have no interior solution, and the boundary
/// takes longer than the rest.
enum class ClosestPoints {
  anywhere,
  interior_only,  ///< where `interior` comes out false, nothing else is set
};

/// Closest point of the triangle a b c to p.
template <class T>
ICLOTH_HD TrianglePoint<T> closest_point_triangle(Vec3<T> p, Vec3<T> a, Vec3<T> b, Vec3<T> c,
                                                  ClosestPoints wanted = ClosestPoints::anywhere) {
  const Vec3<T> e1 = b - a, e2 = c - a, q = p - a, n = cross(e1, e2);
  const T nn = norm2(n);
  TrianglePoint<T> best;
  best.distance2 = T(INFINITY);

  // w1 and w2 are the areas of the two sub-triangles opposite to b and c, times 2|n|.
  const T w1 = dot(cross(q, e2), n), w2 = dot(cross(e1, q), n);
  const T w0 = T(1) - w1 / nn - w2 / nn;

  // A well-conditioned solution inside the face is the answer.
  if (w0 > T(0) && w1 > T(0) && w2 > T(0)) {  // false for nn = 0
    const T height = dot(q, n);
    best = {{w0, w1 / nn, w2 / nn}, height * (height / nn), true};
    if (nn > kIllConditioned2<T> * norm2(e1) * norm2(e2)) return best;
    best.distance2 = norm2(q - best.w[1] * e1 - best.w[2] * e2);
  } else if (wanted == ClosestPoints::interior_only) {
    return best;
  }

  // Otherwise the closest point lies on an edge, or the interior solution has to prove itself
  // against the edges.
  detail::keep_closer(best, p, a, b, 0, 1);
  detail::keep_closer(best, p, b, c, 1, 2);
  detail::keep_closer(best, p, c, a, 2, 0);
  return best;
}

/// Closest points of the segments a0 a1 and b0 b1.
template <class T>
ICLOTH_HD SegmentPoints<T> closest_points_segments(Vec3<T> a0, Vec3<T> a1, Vec3<T> b0, Vec3<T> b1,
                                                   ClosestPoints wanted = ClosestPoints::anywhere) {
  const Vec3<T> e1 = a1 - a0, e2 = b1 - b0, q = b0 - a0, n = cross(e1, e2);
  const T nn = norm2(n);
  SegmentPoints<T> best;
  best.distance2 = T(INFINITY);

  // The common normal meets both lines at s and t.
  const T s = dot(cross(q, e2), n), t = dot(cross(q, e1), n);
  if (s > T(0) && s < nn && t > T(0) && t < nn) {
    const T height = dot(q, n);
    best = {s / nn, t / nn, height * (height / nn), true};
    if (nn > kIllConditioned2<T> * norm2(e1) * norm2(e2)) return best;
    best.distance2 = norm2(q + best.t * e2 - best.s * e1);
  } else if (wanted == ClosestPoints::interior_only) {
    return best;
  }

  // The distance is convex over the square of (s,t), so without an interior minimum there is one on
  // a side of the square.
  const T s0 = closest_on_segment(b0, a0, a1), s1 = closest_on_segment(b1, a0, a1);
  const T t0 = closest_on_segment(a0, b0, b1), t1 = closest_on_segment(a1, b0, b1);
  detail::keep_closer(best, q - s0 * e1, s0, T(0));
  detail::keep_closer(best, b1 - a0 - s1 * e1, s1, T(1));
  detail::keep_closer(best, q + t0 * e2, T(0), t0);
  detail::keep_closer(best, b0 - a1 + t1 * e2, T(1), t1);
  return best;
}

}  // namespace icloth
