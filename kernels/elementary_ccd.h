// Elementary continuous collision detection: do a vertex and a face, or two edges, touch at some
// time in [0,1] when their points move linearly, and when first?
//
// Stands in for the test of Tang et al. 2018, Section 2.2 (exact CCD after Tang et al. 2014). No
// contact of the trajectories between the stored numbers is ever missed, and the reported time is
// never later than the true one. False positives need a gap of about 1e-15 of the extent of the
// pair (float input) or of about 1e-30 (double input), or a query undecided after kMaxSteps.
//
// One front in time moves from 0 to 1, in steps of two kinds, each certified against rounding:
//   - to the first time at which the four points may be coplanar (ccd_first_zero.h);
//   - there, over the time during which some direction separates the primitives
//     (ccd_separation.h, directions from ccd_closest.h).
// Where no direction separates them the front stops: contact. Grazing contacts, parallel edges,
// slivers and pairs that stay coplanar are no special cases: for the last ones the second kind of
// step alone is a conservative advancement. A front that fp64 stops without a clear crossing is
// moved on in double-double arithmetic by the same functions.
#pragma once

#include "kernels/ccd_closest.h"
#include "kernels/ccd_first_zero.h"

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

/// Where the front stopped (`time` > 1: it passed), and what moved it there.
template <class N>
struct Front {
  N time;
  Vec3<N> last{};     // direction that separated the pair …
  N last_end{};       // … up to this time
  N w[4]{};           // weights of the closest points at `time`
  bool clear{false};  // a plain crossing in the interior of both primitives
};

/// f changes its sign for certain within a short time around t.
template <class N>
ICLOTH_HD bool crosses_at(const Bernstein3<N>& f, N t) {
  const N near = N(0x1p-38);
  const N before = f(larger(t - near, N(0))), after = f(smaller(t + near, N(1)));
  return (before > f.error && after < -f.error) || (before < -f.error && after > f.error);
}

template <PairKind K, class N>
ICLOTH_HD void advance(const PairMotion<K, N>& pair, const Bernstein3<N>& f, double margin,
                       Front<N>& front) {
  const N least_step = N(64) * kRoundoff<N>;  // less than this is no progress
  for (int step = 0; step < kMaxSteps; ++step) {
    front.time = first_zero_bound(f, front.time);
    if (front.time > N(1)) return;
    const ClosestPair<N> closest = closest_pair(pair, front.time);
    for (int k = 0; k < 4; ++k) front.w[k] = closest.w[k];
    front.clear = !closest.doubtful && crosses_at(f, front.time);
    if (front.clear) return;
    const N needed = front.time + least_step;
    Vec3<N> direction = closest.first;
    N end = separated_until(pair, direction, margin, front.time);
    if (end < needed && closest.doubtful) {
      direction = closest.second;
      end = separated_until(pair, direction, margin, front.time);
    }
    if (end < needed) end = separated_by_axes_until(pair, margin, front.time, direction);
    if (end < needed) return;
    front.time = end;
    if (end > N(1)) return;
    front.last = direction;
    front.last_end = end;
  }
}

/// Gap vector of weights w for the given differences between the two primitives.
template <PairKind K>
ICLOTH_HD Vec3d weighted_gap(const double* w, const Vec3d* r) {
  Vec3d gap;
  for (int i = 0; i < kDifferences<K>; ++i) {
    const double share = K == PairKind::vf ? -w[1 + i] : -w[2 + i / 2] * w[i % 2];
    gap += share * r[i];
  }
  return gap;
}

/// The volume somewhere between 0 and the contact; 0 when it vanishes within rounding throughout.
ICLOTH_HD inline double side_before(const Bernstein3<double>& f, double toi) {
  if (std::fabs(f.c[0]) > f.error) return f.c[0];
  double largest = 0;
  for (int k = 1; k < 8; ++k) {
    const double value = f(0.125 * k * toi);
    if (std::fabs(value) > std::fabs(largest)) largest = value;
  }
  return std::fabs(largest) > f.error ? largest : 0.0;
}

/// Direction of the gap shortly before the contact, for pairs without a plane of contact.
template <PairKind K>
ICLOTH_HD Vec3d direction_before(const PairMotion<K, double>& pair, double toi) {
  const double t = 0.95 * toi;
  const ClosestPair<double> closest = closest_pair(pair, t);
  Vec3d r[kDifferences<K>];
  for (int i = 0; i < kDifferences<K>; ++i) r[i] = pair.at(t, i);
  return normalized(weighted_gap<K>(closest.w, r));
}

/// `last`: unit direction that separated the pair shortly before the contact, or zero.
template <PairKind K>
ICLOTH_HD Vec3d contact_normal(const PairMotion<K, double>& pair, const VolumeVectors<double>& v,
                               const Bernstein3<double>& f, const CcdHit& hit, Vec3d last) {
  const double t = hit.toi;
  const Vec3d b = (1 - t) * v.b0 + t * v.b1, c = (1 - t) * v.c0 + t * v.c1, n = cross(b, c);
  // The volume is n·gap and keeps its sign up to the contact: its sign at the start tells the side.
  const double side = side_before(f, t);
  if (side != 0 && norm2(n) > 1e-16 * norm2(b) * norm2(c)) return normalized(side > 0 ? n : -n);
  if (norm2(last) > 0) return last;
  const Vec3d before = direction_before(pair, t);
  if (norm2(before) > 0) return before;
  // In touch from the start, no side known: oppose the relative motion.
  const Vec3d motion = weighted_gap<K>(hit.w, pair.r1) - weighted_gap<K>(hit.w, pair.r0);
  const Vec3d any = norm2(n) > 0 ? normalized(n) : normalized(-motion);
  if (!(norm2(any) > 0)) return {0, 1, 0};
  return dot(any, motion) > 0 ? -any : any;
}

/// Not a number, infinite, or so large that a determinant could overflow.
template <PairKind K, class T>
ICLOTH_HD bool out_of_range(const Vec3<T>* r0, const Vec3<T>* r1) {
  T sum{};
  for (int i = 0; i < kDifferences<K>; ++i) {
    sum += std::fabs(r0[i].x) + std::fabs(r0[i].y) + std::fabs(r0[i].z) + std::fabs(r1[i].x) +
           std::fabs(r1[i].y) + std::fabs(r1[i].z);
  }
  return !(sum < (sizeof(T) == 4 ? T(1e12) : T(1e90)));
}

template <PairKind K>
ICLOTH_HD CcdHit undecidable() {
  if (K == PairKind::ee) return {0, {-0.5, -0.5, 0.5, 0.5}, {0, 1, 0}};
  return {0, {1, -1. / 3, -1. / 3, -1. / 3}, {0, 1, 0}};
}

/// Moves a front that fp64 stopped on; true when the contact stands.
template <PairKind K>
ICLOTH_HD bool confirm(const CcdQuery<double>& query, double margin, Front<double>& front) {
  const PairMotion<K, DoubleDouble> pair(query);
  const Bernstein3<DoubleDouble> f(volume_cubic(volume_vectors<K, DoubleDouble>(query)));
  Front<DoubleDouble> fine{front.time};
  advance(pair, f, margin, fine);
  if (fine.time > DoubleDouble(1)) return false;
  front.time = fine.time.hi;
  if (fine.time.lo < 0) front.time *= 1 - 0x1p-52;  // rounds down
  for (int k = 0; k < 4; ++k) front.w[k] = fine.w[k].hi;
  if (fine.last_end > DoubleDouble(0)) {
    front.last = rounded(fine.last);
    front.last_end = fine.last_end.hi;
  }
  return true;
}

template <PairKind K, class T>
ICLOTH_HD bool elementary_ccd(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  const PairMotion<K, double> pair(query);
  if (out_of_range<K>(pair.r0, pair.r1)) {
    hit = undecidable<K>();
    return true;
  }
  if (separated_by_axis<K>(pair.r0, pair.r1)) return false;
  const VolumeVectors<double> volume = volume_vectors<K, double>(query);
  const VolumeCubic<double> cubic = volume_cubic(volume);
  if (cubic.certainly_nonzero()) return false;

  const Bernstein3<double> f(cubic);
  const double margin = f.vanishes() ? separation : 0;
  Front<double> front{0};
  advance(pair, f, margin, front);
  if (front.time > 1) return false;
  if constexpr (sizeof(T) == 8) {
    if (!front.clear && !confirm<K>(query, margin, front)) return false;
  }
  hit.toi = front.time;
  for (int k = 0; k < 4; ++k) hit.w[k] = front.w[k];
  const Vec3d last = front.last_end > 0.95 * front.time ? normalized(front.last) : Vec3d{};
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
