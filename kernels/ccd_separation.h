// Two primitives, vertex and face or edge and edge, whose points move linearly: differences of
// their points, closest points at a time, and certified separation by a fixed direction.
//
// A direction d separates the primitives at time t when d·(y − x) > 0 for all points x of the first
// and y of the second. For a fixed d these are a few linear functions of t, so a separation
// interval follows from their values at t = 0 and t = 1. The certificate bounds its own rounding
// errors and does not depend on how d was found: a badly chosen d costs a false positive, never a
// missed contact.
#pragma once

#include "kernels/ccd_cubic.h"
#include "kernels/distance.h"

namespace icloth {

/// Four points at t = 0 and t = 1. vf: vertex, face v0 v1 v2. ee: a0 a1 b0 b1.
template <class T>
struct CcdQuery {
  Vec3<T> p0[4], p1[4];
};

enum class PairKind { vf, ee };

/// Number of differences between points of the two primitives.
template <PairKind K>
inline constexpr int kDifferences = K == PairKind::vf ? 3 : 4;

/// Difference i at one end. vf: vertex − v_i. ee: b0 − a0, b0 − a1, b1 − a0, b1 − a1.
template <PairKind K, class To, class T>
ICLOTH_HD Vec3<To> point_difference(const Vec3<T>* x, int i) {
  if constexpr (K == PairKind::vf) return convert<To>(x[0]) - convert<To>(x[i + 1]);
  return convert<To>(x[2 + i / 2]) - convert<To>(x[i % 2]);
}

/// Edges of the face from v0 and vertex − v0, or both edges and b0 − a0.
template <PairKind K, class To, class T>
ICLOTH_HD VolumeVectors<To> volume_vectors(const CcdQuery<T>& q) {
  const int o = K == PairKind::vf ? 1 : 0;  // where b and p start
  const int c0 = K == PairKind::vf ? 1 : 2, c1 = 3;
  const int b1 = K == PairKind::vf ? 2 : 1, p = K == PairKind::vf ? 0 : 2;
  const auto at = [](Vec3<T> a) { return convert<To>(a); };
  return {at(q.p0[b1]) - at(q.p0[o]), at(q.p0[c1]) - at(q.p0[c0]), at(q.p0[p]) - at(q.p0[o]),
          at(q.p1[b1]) - at(q.p1[o]), at(q.p1[c1]) - at(q.p1[c0]), at(q.p1[p]) - at(q.p1[o])};
}

/// True when a coordinate axis separates the primitives at both ends, hence always: then no swept
/// boxes meet at equal times. Exact: the sign of a difference of two floating-point numbers is.
template <PairKind K, class T>
ICLOTH_HD bool separated_by_axis(const Vec3<T>* r0, const Vec3<T>* r1) {
  bool above[3] = {true, true, true}, below[3] = {true, true, true};
  for (int i = 0; i < kDifferences<K>; ++i) {
    above[0] &= r0[i].x > 0 && r1[i].x > 0;
    above[1] &= r0[i].y > 0 && r1[i].y > 0;
    above[2] &= r0[i].z > 0 && r1[i].z > 0;
    below[0] &= r0[i].x < 0 && r1[i].x < 0;
    below[1] &= r0[i].y < 0 && r1[i].y < 0;
    below[2] &= r0[i].z < 0 && r1[i].z < 0;
  }
  return above[0] || above[1] || above[2] || below[0] || below[1] || below[2];
}

/// All differences in fp64 at both ends.
template <PairKind K>
struct PairMotion {
  static constexpr int kCount = kDifferences<K>;
  Vec3d r0[kCount], r1[kCount];
  Vec3d size;  // largest |component| of the differences, axis by axis

  template <class T>
  ICLOTH_HD explicit PairMotion(const CcdQuery<T>& q) {
    for (int i = 0; i < kCount; ++i) {
      r0[i] = point_difference<K, double>(q.p0, i);
      r1[i] = point_difference<K, double>(q.p1, i);
      grow(r0[i]);
      grow(r1[i]);
    }
  }
  ICLOTH_HD Vec3d at(double t, int i) const { return (1 - t) * r0[i] + t * r1[i]; }

 private:
  ICLOTH_HD void grow(Vec3d r) {
    size = {std::fmax(size.x, std::fabs(r.x)), std::fmax(size.y, std::fabs(r.y)),
            std::fmax(size.z, std::fabs(r.z))};
  }
};

/// End of the time interval that starts at t and in which d separates the primitives by more than
/// `margin` [length]; t itself when they are not separated there. Everything rounds down.
template <PairKind K>
ICLOTH_HD double separated_until(const PairMotion<K>& pair, Vec3d d, double margin, double t) {
  // Dot product of rounded differences: 4 roundings a term at most; 5 and a floor for underflow.
  const double error = 5 * kRoundoff<double> *
                           (std::fabs(d.x) * pair.size.x + std::fabs(d.y) * pair.size.y +
                            std::fabs(d.z) * pair.size.z) +
                       1e-300 + (margin > 0 ? margin * norm(d) : 0.0);
  double end = 1;
  for (int i = 0; i < PairMotion<K>::kCount; ++i) {
    const double s0 = dot(d, pair.r0[i]) - error, s1 = dot(d, pair.r1[i]) - error;
    if (s0 > 0 && s1 > 0) continue;
    const double crossing = s0 / (s0 - s1);
    if (s0 > 0) {  // positive before the crossing
      end = std::fmin(end, crossing * (1 - 0x1p-50));
    } else if (!(s1 > 0) || !(t > crossing * (1 + 0x1p-50))) {
      return t;
    }
  }
  return std::fmax(end, t);
}

/// Closest points at one time and directions that may separate.
struct ClosestPair {
  double w[4];    // weights of the four points in the gap vector Σ w x
  Vec3d first;    // most promising direction, from the closest features
  Vec3d second;   // another one, worth trying when `doubtful`
  bool doubtful;  // ill-conditioned or close to a change of features
};

namespace detail {

/// Component of r orthogonal to e; twice, so that nothing along e but rounding of the result stays.
ICLOTH_HD inline Vec3d orthogonal_to(Vec3d r, Vec3d e) {
  const double ee = norm2(e);
  if (!(ee > 0)) return r;
  const Vec3d d = r - (dot(r, e) / ee) * e;
  return d - (dot(d, e) / ee) * e;
}
ICLOTH_HD inline Vec3d towards(Vec3d d, Vec3d r) { return dot(d, r) < 0 ? -d : d; }

inline constexpr double kNearBorder = 1e-6;

}  // namespace detail

/// Closest points of vertex and face at time t.
ICLOTH_HD inline ClosestPair closest_pair(const PairMotion<PairKind::vf>& pair, double t) {
  const Vec3d r[3] = {pair.at(t, 0), pair.at(t, 1), pair.at(t, 2)};
  const TrianglePoint<double> x = closest_point_triangle(Vec3d{}, r[0], r[1], r[2]);
  const Vec3d n = detail::towards(cross(r[1] - r[0], r[2] - r[0]), r[0]);
  ClosestPair out{{1, -x.w[0], -x.w[1], -x.w[2]}, n, n, true};
  // Opposite to the smallest weight lies the closest edge (or one of the two at a vertex).
  const int k = x.w[0] <= x.w[1] ? (x.w[0] <= x.w[2] ? 0 : 2) : (x.w[1] <= x.w[2] ? 1 : 2);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const Vec3d edge = r[j] - r[i];
  Vec3d side;
  if (x.w[i] > 0 && x.w[j] > 0) {
    side = detail::orthogonal_to(x.w[i] > x.w[j] ? r[i] : r[j], edge);
  } else {
    side = x.w[i] > 0 ? r[i] : r[j];
  }
  if (x.interior) {
    out.second = side;
    out.doubtful = x.w[k] < detail::kNearBorder ||
                   !(norm2(n) > 1e-8 * norm2(r[1] - r[0]) * norm2(r[2] - r[0]));
  } else {
    out.first = side;
  }
  return out;
}

/// Closest points of two edges at time t.
ICLOTH_HD inline ClosestPair closest_pair(const PairMotion<PairKind::ee>& pair, double t) {
  // With a0 as the origin: a1 = r0 − r1, b0 = r0, b1 = r2.
  const Vec3d r[4] = {pair.at(t, 0), pair.at(t, 1), pair.at(t, 2), pair.at(t, 3)};
  const Vec3d e1 = r[0] - r[1], e2 = r[2] - r[0];
  const SegmentPoints<double> x = closest_points_segments(Vec3d{}, e1, r[0], r[2]);
  const Vec3d n = detail::towards(cross(e1, e2), r[0]);
  ClosestPair out{{-(1 - x.s), -x.s, 1 - x.t, x.t}, n, n, true};
  const Vec3d nearest = r[(x.s > 0.5 ? 1 : 0) + (x.t > 0.5 ? 2 : 0)];
  const bool inside_a = x.s > 0 && x.s<1, inside_b = x.t> 0 && x.t < 1;
  if (inside_a && inside_b) {
    const double border = std::fmin(std::fmin(x.s, 1 - x.s), std::fmin(x.t, 1 - x.t));
    out.second = detail::orthogonal_to(nearest, norm2(e1) > norm2(e2) ? e1 : e2);
    out.doubtful = border < detail::kNearBorder || !(norm2(n) > 1e-8 * norm2(e1) * norm2(e2));
  } else if (inside_a || inside_b) {
    out.first = detail::orthogonal_to(nearest, inside_a ? e1 : e2);
  } else {
    out.first = nearest;
  }
  return out;
}

}  // namespace icloth
