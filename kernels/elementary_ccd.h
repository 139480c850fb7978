// Elementary continuous collision detection: do a vertex and a face, or two edges, touch at some
// time in [0,1] when their points move linearly, and when first?
//
// Stands in for the test of Tang et al. 2018, Section 2.2 (exact CCD after Tang et al. 2014). No
// contact of the trajectories between the stored numbers is ever missed, and the reported time is
// never later than the true one. False positives need a gap of about 1e-15 of the extent of the
// pair, or a query that is not decided within kMaxSteps.
//
// One front in time moves from 0 to 1, in steps of two kinds, each certified against rounding:
//   - to the first time at which the four points may be coplanar (ccd_cubic.h);
//   - there, over the time during which a direction separates the primitives (ccd_separation.h).
// Where no direction separates them the front stops: contact. Grazing contacts, parallel edges,
// slivers and pairs that stay coplanar are no special cases: for the last ones the second step
// alone is a conservative advancement.
#pragma once

#include "kernels/ccd_separation.h"

namespace icloth {

/// The first contact of a pair.
struct CcdHit {
  double toi{};  // time of impact in [0,1], never late
  double w[4]{};  // gap vector Σ w_a x_a. vf: +1, −α0, −α1, −α2. ee: −(1−s), −s, +(1−r), +r
  Vec3d normal{};  // unit; positive towards the side of the gap vector before the contact
};

/// Steps of the front after which a query counts as a contact.
inline constexpr int kMaxSteps = 100;

namespace detail {

/// Not a number, infinite, or so large that a determinant could overflow.
template <PairKind K, class T>
ICLOTH_HD bool out_of_range(const Vec3<T>* r0, const Vec3<T>* r1) {
  T sum{};
  for (int i = 0; i < kDifferences<K>; ++i) {
    sum += std::fabs(r0[i].x) + std::fabs(r0[i].y) + std::fabs(r0[i].z) + std::fabs(r1[i].x) +
           std::fabs(r1[i].y) + std::fabs(r1[i].z);
  }
  return !(sum < (sizeof(T) == 4 ? T(1e12) : T(1e100)));
}

/// Last direction known to separate the pair, or the closest points shortly before the contact.
template <PairKind K>
ICLOTH_HD Vec3d direction_before(const PairMotion<K>& pair, double toi, Vec3d last) {
  if (norm2(last) > 0) return normalized(last);
  const ClosestPair before = closest_pair(pair, 0.95 * toi);
  Vec3d gap;
  for (int i = 0; i < PairMotion<K>::kCount; ++i) {
    const double share =
        K == PairKind::vf ? -before.w[1 + i] : before.w[2 + i / 2] * -before.w[i % 2];
    gap += share * pair.at(0.95 * toi, i);
  }
  return normalized(gap);
}

/// Sign of the volume between 0 and the contact; 0 when it vanishes within rounding throughout.
ICLOTH_HD inline double side_before(const Bernstein3& f, double toi) {
  double largest = 0;
  if (std::fabs(f.c[0]) > f.error) return f.c[0];
  for (int k = 1; k < 8; ++k) {
    const double value = f(0.125 * k * toi);
    if (std::fabs(value) > std::fabs(largest)) largest = value;
  }
  return std::fabs(largest) > f.error ? largest : 0.0;
}

template <PairKind K>
ICLOTH_HD Vec3d contact_normal(const PairMotion<K>& pair, const VolumeVectors<double>& v,
                               const Bernstein3& f, const CcdHit& hit, Vec3d last) {
  const double t = hit.toi;
  const Vec3d b = (1 - t) * v.b0 + t * v.b1, c = (1 - t) * v.c0 + t * v.c1, n = cross(b, c);
  // The volume is n·gap and keeps its sign up to the contact: its sign at the start tells the side.
  const double side = side_before(f, t);
  if (side != 0 && norm2(n) > 1e-16 * norm2(b) * norm2(c)) {
    return normalized(side > 0 ? n : -n);
  }
  const Vec3d direction = direction_before(pair, t, last);
  if (norm2(direction) > 0) return direction;
  // In touch from the start, no side known: oppose the relative motion.
  Vec3d motion;
  for (int i = 0; i < PairMotion<K>::kCount; ++i) {
    const double share = K == PairKind::vf ? -hit.w[1 + i] : hit.w[2 + i / 2] * -hit.w[i % 2];
    motion += share * (pair.r1[i] - pair.r0[i]);
  }
  const Vec3d any = norm2(n) > 0 ? normalized(n) : normalized(-motion);
  if (!(norm2(any) > 0)) return {0, 1, 0};
  return dot(any, motion) > 0 ? -any : any;
}

template <PairKind K, class T>
ICLOTH_HD bool elementary_ccd(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  const PairMotion<K> pair(query);
  if (out_of_range<K>(pair.r0, pair.r1)) {
    hit = {0, {1, -1. / 3, -1. / 3, -1. / 3}, {0, 1, 0}};
    if (K == PairKind::ee) hit = {0, {-0.5, -0.5, 0.5, 0.5}, {0, 1, 0}};
    return true;
  }
  if (separated_by_axis<K>(pair.r0, pair.r1)) return false;
  const VolumeVectors<double> volume = volume_vectors<K, double>(query);
  const VolumeCubic<double> cubic = volume_cubic(volume);
  if (cubic.certainly_nonzero()) return false;
  const Bernstein3 f(cubic);
  const double margin = f.vanishes() ? separation : 0;

  double front = 0, last_end = 0;
  Vec3d last;  // separated the pair up to last_end
  ClosestPair closest;
  for (int step = 0; step < kMaxSteps; ++step) {
    front = first_zero_bound(f, front);
    if (front > 1) return false;
    closest = closest_pair(pair, front);
    Vec3d direction = closest.first;
    double end = separated_until(pair, direction, margin, front);
    if (!(end > front) && closest.doubtful) {
      direction = closest.second;
      end = separated_until(pair, direction, margin, front);
    }
    if (!(end > front)) break;
    if (end >= 1) return false;
    front = last_end = end;
    last = direction;
  }
  hit.toi = front;
  for (int k = 0; k < 4; ++k) hit.w[k] = closest.w[k];
  if (!(last_end > 0.95 * front)) last = {};
  hit.normal = contact_normal(pair, volume, f, hit, last);
  return true;
}

}  // namespace detail

/// Cheap test in the precision of the input: false when the pair certainly does not touch in [0,1],
/// true when it may (also for numbers that are not finite). No division, no iteration.
template <PairKind K, class T>
ICLOTH_HD bool ccd_filter(const CcdQuery<T>& query) {
  constexpr int n = kDifferences<K>;
  Vec3<T> r0[n], r1[n];
  for (int i = 0; i < n; ++i) {
    r0[i] = point_difference<K, T>(query.p0, i);
    r1[i] = point_difference<K, T>(query.p1, i);
  }
  if (detail::out_of_range<K>(r0, r1)) return true;
  if (separated_by_axis<K>(r0, r1)) return false;
  return !volume_cubic(volume_vectors<K, T>(query)).certainly_nonzero();
}

/// Vertex against face. On true, `hit` holds the first contact. `separation` [length] is the gap
/// below which pairs that stay coplanar throughout count as touching; 0: only what touches.
template <class T>
ICLOTH_HD bool ccd_vf(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  return detail::elementary_ccd<PairKind::vf>(query, separation, hit);
}

/// Edge against edge; otherwise as ccd_vf.
template <class T>
ICLOTH_HD bool ccd_ee(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  return detail::elementary_ccd<PairKind::ee>(query, separation, hit);
}

}  // namespace icloth
