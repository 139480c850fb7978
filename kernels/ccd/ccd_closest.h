// The closest points of a moving pair at one time, and directions that may separate the pair there.
//
// The directions are built from the closest features (normal of the face, common normal of two
// edges, perpendicular to one edge, difference of two points) rather than from the difference of
// the closest points: that one loses its direction to rounding when the gap is small.
#pragma once

#include "kernels/ccd/ccd_separation.h"
#include "kernels/distance.h"

namespace icloth {

template <class N>
struct ClosestPair {
  N w[4];          // weights of the four points in the gap vector Σ w x
  Vec3<N> first;   // most promising direction
  Vec3<N> second;  // another one, worth trying when `doubtful`
  bool doubtful;   // ill-conditioned, or close to the border of a feature
  N depth{};       // unless `doubtful`: |n|² times the smallest distance of a weight from 0 or 1
};

namespace detail {

inline constexpr double kNearBorder = 1e-6;
inline constexpr double kThin2 = 1e-8;  // squared sine of the angle between two edges

/// Component of r orthogonal to e. The projection runs twice, so that only the rounding of the
/// result stays along e.
template <class N>
ICLOTH_HD Vec3<N> orthogonal_to(Vec3<N> r, Vec3<N> e) {
  const N ee = norm2(e);
  if (!(ee > N(0))) return r;
  const Vec3<N> d = r - (dot(r, e) / ee) * e;
  return d - (dot(d, e) / ee) * e;
}
/// d or −d, whichever points towards r.
template <class N>
ICLOTH_HD Vec3<N> towards(Vec3<N> d, Vec3<N> r) {
  return dot(d, r) < N(0) ? -d : d;
}

}  // namespace detail

/// Closest points of vertex and face at time t. The differences r are the pair mirrored in a point,
/// with the vertex at the origin.
template <class N>
ICLOTH_HD ClosestPair<N> closest_pair(const PairMotion<PairKind::vf, N>& pair, N t) {
  const Vec3<N> r[3] = {pair.at(t, 0), pair.at(t, 1), pair.at(t, 2)};
  const Vec3<N> e1 = r[1] - r[0], e2 = r[2] - r[0];
  const Vec3<N> n = detail::towards(cross(e1, e2), r[0]);
  const TrianglePoint<N> x = closest_point_triangle(Vec3<N>{}, r[0], r[1], r[2]);
  ClosestPair<N> out{{N(1), -x.w[0], -x.w[1], -x.w[2]}, n, n, false};
  // The edge opposite to the smallest weight is the closest one.
  const int k = x.w[0] <= x.w[1] ? (x.w[0] <= x.w[2] ? 0 : 2) : (x.w[1] <= x.w[2] ? 1 : 2);

  // Where the closest point is inside the face and not near its border, the normal of the face is
  // the only promising direction.
  if (x.interior) {
    const bool thin = !(norm2(n) > N(detail::kThin2) * norm2(e1) * norm2(e2));
    out.doubtful = thin || x.w[k] < N(detail::kNearBorder);
    out.depth = x.w[k] * norm2(n);
    if (!out.doubtful) return out;
  }

  // Near or on the border the closest feature is an edge, whose perpendicular counts, or an end of
  // it.
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  Vec3<N> side = x.w[i] > x.w[j] ? r[i] : r[j];
  if (x.w[i] > N(0) && x.w[j] > N(0)) side = detail::orthogonal_to(side, r[j] - r[i]);
  (x.interior ? out.second : out.first) = side;
  out.doubtful = true;
  return out;
}

/// Closest points of two edges at time t.
template <class N>
ICLOTH_HD ClosestPair<N> closest_pair(const PairMotion<PairKind::ee, N>& pair, N t) {
  // With a0 as the origin: a1 = r0 − r1, b0 = r0, b1 = r2.
  const Vec3<N> r[4] = {pair.at(t, 0), pair.at(t, 1), pair.at(t, 2), pair.at(t, 3)};
  const Vec3<N> e1 = r[0] - r[1], e2 = r[2] - r[0];
  const Vec3<N> n = detail::towards(cross(e1, e2), r[0]);
  const SegmentPoints<N> x = closest_points_segments(Vec3<N>{}, e1, r[0], r[2]);
  ClosestPair<N> out{{x.s - N(1), -x.s, N(1) - x.t, x.t}, n, n, false};
  const bool inside_a = x.s > N(0) && x.s<N(1), inside_b = x.t> N(0) && x.t < N(1);

  // Where both closest points are inside their edges, the common normal is the direction to try. It
  // is doubtful when the edges are nearly parallel or one of the points is near an end.
  if (inside_a && inside_b) {
    const N border =
        detail::smaller(detail::smaller(x.s, N(1) - x.s), detail::smaller(x.t, N(1) - x.t));
    const bool thin = !(norm2(n) > N(detail::kThin2) * norm2(e1) * norm2(e2));
    out.doubtful = thin || border < N(detail::kNearBorder);
    out.depth = border * norm2(n);
    if (!out.doubtful) return out;
  }

  // Otherwise a pair of end points is closest, or an end point and an edge. In the first case their
  // difference is the direction, in the second its part perpendicular to the edge.
  const Vec3<N> nearest = r[(x.s > N(0.5) ? 1 : 0) + (x.t > N(0.5) ? 2 : 0)];
  Vec3<N> side = nearest;
  if (inside_a || inside_b) {
    const bool along_a = inside_a && (!inside_b || norm2(e1) > norm2(e2));
    side = detail::orthogonal_to(nearest, along_a ? e1 : e2);
  }
  (inside_a && inside_b ? out.second : out.first) = side;
  out.doubtful = true;
  return out;
}

}  // namespace icloth
