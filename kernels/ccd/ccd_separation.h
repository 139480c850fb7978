// Two primitives, vertex and face or edge and edge, whose points move linearly: the differences of
// their points, and certified separation by a fixed direction.
//
// A direction d separates the primitives at time t when d·(y − x) > 0 for all points x of the one
// and y of the other. For a fixed d these are three or four linear functions of t, so the time of
// separation follows from their values at t = 0 and t = 1. The certificate bounds its own rounding
// errors and does not depend on how d was found: a badly chosen d costs a false positive, never a
// missed contact.
#pragma once

#include "kernels/ccd/ccd_cubic.h"

namespace icloth {

/// Four points at t = 0 and t = 1. They are vertex and face v0 v1 v2 for vf, a0 a1 b0 b1 for ee.
template <class T>
struct CcdQuery {
  Vec3<T> p0[4], p1[4];
};

enum class PairKind { vf, ee };

/// Number of differences between points of the two primitives.
template <PairKind K>
inline constexpr int kDifferences = K == PairKind::vf ? 3 : 4;

/// Difference i of the points x at one end. For vf it is vertex − v_i; for ee the differences are
/// b0 − a0, b0 − a1, b1 − a0 and b1 − a1.
template <PairKind K, class To, class T>
ICLOTH_HD Vec3<To> point_difference(const Vec3<T>* x, int i) {
  if constexpr (K == PairKind::vf) return convert<To>(x[0]) - convert<To>(x[i + 1]);
  return convert<To>(x[2 + i / 2]) - convert<To>(x[i % 2]);
}

/// The vectors of the volume: the edges of the face from v0 and vertex − v0, or both edges and b0 −
/// a0.
template <PairKind K, class To, class T>
ICLOTH_HD VolumeVectors<To> volume_vectors(const CcdQuery<T>& q) {
  constexpr bool vf = K == PairKind::vf;
  // b goes from o to b1, c from c0 to the last point, p starts at o.
  constexpr int o = vf ? 1 : 0, b1 = vf ? 2 : 1, c0 = vf ? 1 : 2, p = vf ? 0 : 2;
  const auto difference = [](Vec3<T> x, Vec3<T> y) { return convert<To>(x) - convert<To>(y); };
  return {difference(q.p0[b1], q.p0[o]), difference(q.p0[3], q.p0[c0]),
          difference(q.p0[p], q.p0[o]),  difference(q.p1[b1], q.p1[o]),
          difference(q.p1[3], q.p1[c0]), difference(q.p1[p], q.p1[o])};
}

/// True when a coordinate axis separates the primitives by more than `margin` at both ends, hence
/// always. It is exact for a margin of 0, as the sign of the difference of two floating-point
/// numbers is.
template <PairKind K, class T>
ICLOTH_HD bool separated_by_axis(const Vec3<T>* r0, const Vec3<T>* r1, T margin) {
  // The smallest and the largest difference along each axis, over all pairs of points and both
  // ends.
  Vec3<T> least = r0[0], most = r0[0];
  const auto include = [&](Vec3<T> r) {
    least = {detail::smaller(least.x, r.x), detail::smaller(least.y, r.y),
             detail::smaller(least.z, r.z)};
    most = {detail::larger(most.x, r.x), detail::larger(most.y, r.y), detail::larger(most.z, r.z)};
  };
  include(r1[0]);
  for (int i = 1; i < kDifferences<K>; ++i) {
    include(r0[i]);
    include(r1[i]);
  }

  // Differences of one sign along an axis mean that the axis separates.
  return detail::larger(least.x, detail::larger(least.y, least.z)) > margin ||
         detail::smaller(most.x, detail::smaller(most.y, most.z)) < -margin;
}

/// All differences of the pair in N (double or DoubleDouble) at both ends.
template <PairKind K, class N>
struct PairMotion {
  static constexpr int kCount = kDifferences<K>;
  Vec3<N> r0[kCount], r1[kCount];
  Vec3<N> size;  // largest |component| of the differences, axis by axis

  template <class T>
  ICLOTH_HD explicit PairMotion(const CcdQuery<T>& q) {
    for (int i = 0; i < kCount; ++i) {
      r0[i] = point_difference<K, N>(q.p0, i);
      r1[i] = point_difference<K, N>(q.p1, i);
      grow(r0[i]);
      grow(r1[i]);
    }
  }
  ICLOTH_HD Vec3<N> at(N t, int i) const { return (N(1) - t) * r0[i] + t * r1[i]; }

 private:
  ICLOTH_HD void grow(Vec3<N> r) {
    size = {detail::larger(size.x, detail::absolute(r.x)),
            detail::larger(size.y, detail::absolute(r.y)),
            detail::larger(size.z, detail::absolute(r.z))};
  }
};

namespace detail {

/// The time interval in which a few linear functions of t are all positive, narrowed down function
/// by function.
template <class N>
struct PositiveSpan {
  N t;            // the interval has to hold this time …
  N end{kNever};  // … and reaches to here
  bool holds{true};

  /// Takes one function into account. s0 and s1 are lower bounds of it at t = 0 and 1, up to
  /// relative rounding errors.
  ICLOTH_HD void narrow(N s0, N s1) {
    if (s0 > N(0) && s1 > N(0)) return;
    const N crossing = s0 / (s0 - s1);
    const N pad = N(16) * kRoundoff<N>;
    if (s0 > N(0)) {  // positive before the crossing
      end = smaller(end, crossing * (N(1) - pad));
    } else if (!(s1 > N(0)) || !(t > crossing * (N(1) + pad))) {
      holds = false;
    }
  }
  ICLOTH_HD N result() const { return holds ? larger(end, t) : t; }
};

ICLOTH_HD inline Vec3d rounded(Vec3d a) { return a; }
ICLOTH_HD inline Vec3d rounded(Vec3<DoubleDouble> a) { return {a.x.hi, a.y.hi, a.z.hi}; }

template <class N>
ICLOTH_HD N component(Vec3<N> a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

}  // namespace detail

/// The end of the time interval that starts at t and in which d separates the primitives by more
/// than `margin` [length]. It is kNever when the interval reaches beyond 1, and t itself when they
/// are not separated there. Everything rounds down.
template <PairKind K, class N>
ICLOTH_HD N separated_until(const PairMotion<K, N>& pair, Vec3<N> d, double margin, N t) {
  // A dot product of rounded differences has 4 roundings a term at most; 6 are counted, and a floor
  // covers underflow.
  const N reach = detail::absolute(d.x) * pair.size.x + detail::absolute(d.y) * pair.size.y +
                  detail::absolute(d.z) * pair.size.z;
  N error = N(6) * kRoundoff<N> * reach + N(1e-290);
  if (margin > 0) error = error + N(margin * norm(detail::rounded(d)));
  detail::PositiveSpan<N> span{t};
  for (int i = 0; i < PairMotion<K, N>::kCount && span.holds; ++i) {
    span.narrow(dot(d, pair.r0[i]) - error, dot(d, pair.r1[i]) - error);
  }
  return span.result();
}

/// The latest end over the six directions along the axes, and its direction in d. A difference of
/// two stored numbers has a relative error only, so here the smallest gap counts and nothing is
/// subtracted.
template <PairKind K, class N>
ICLOTH_HD N separated_by_axes_until(const PairMotion<K, N>& pair, double margin, N t, Vec3<N>& d) {
  N best = t;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const N sign = side % 2 == 0 ? N(1) : N(-1);
    detail::PositiveSpan<N> span{t};
    for (int i = 0; i < PairMotion<K, N>::kCount && span.holds; ++i) {
      span.narrow(sign * detail::component(pair.r0[i], axis) - N(margin),
                  sign * detail::component(pair.r1[i], axis) - N(margin));
    }
    if (!(span.result() > best)) continue;
    best = span.result();
    d = {axis == 0 ? sign : N(0), axis == 1 ? sign : N(0), axis == 2 ? sign : N(0)};
  }
  return best;
}

}  // namespace icloth
