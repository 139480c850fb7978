// Elementary continuous collision detection: do a vertex and a face, or two edges, touch at some
// time in [0,1] when their points move linearly, and when first?
//
// It stands in for the test of Tang et al. 2018, Section 2.2 (exact CCD after Tang et al. 2014). No
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
// step alone is a conservative advancement. Nor are faces and edges that collapse, whose volume
// changes its sign far from any contact (ccd_collapse.h). A front that fp64 stops without a clear
// crossing is moved on in double-double arithmetic by the same functions.
#pragma once

#include "kernels/ccd/ccd_collapse.h"
#include "kernels/ccd/ccd_first_zero.h"

namespace icloth {

/// The first contact of a pair.
struct CcdHit {
  double toi{};  // time of impact in [0,1], never late
  double w[4]{};  // gap vector Σ w_a x_a. vf: +1, −α0, −α1, −α2. ee: −(1−s), −s, +(1−r), +r
  Vec3d normal{};  // unit; positive towards the side of the gap vector before the contact
};

/// Number of steps of the front after which a query counts as a contact.
inline constexpr int kMaxSteps = 100;

/// From this step in double-double arithmetic on, the steps may also follow the turning of edges,
/// since the front moves too slowly for fixed directions.
inline constexpr int kFirstTurningStep = 4;

namespace detail {

/// True for differences that are not numbers, infinite, or so large that a determinant could
/// overflow.
template <PairKind K, class T>
ICLOTH_HD bool out_of_range(const Vec3<T>* r0, const Vec3<T>* r1) {
  T sum{};
  for (int i = 0; i < kDifferences<K>; ++i) {
    sum += std::fabs(r0[i].x) + std::fabs(r0[i].y) + std::fabs(r0[i].z) + std::fabs(r1[i].x) +
           std::fabs(r1[i].y) + std::fabs(r1[i].z);
  }
  return !(sum < (sizeof(T) == 4 ? T(1e12) : T(1e90)));
}

}  // namespace detail

/// A cheap test in the precision of the input: false when the pair certainly does not touch in
/// [0,1], true when it may (also for numbers that are not finite). It needs no division and no
/// iteration. With the `separation` of the full test it keeps whatever that test may report.
template <PairKind K, class T>
ICLOTH_HD bool ccd_filter(const CcdQuery<T>& query, double separation = 0) {
  constexpr int n = kDifferences<K>;
  Vec3<T> r0[n], r1[n];
  for (int i = 0; i < n; ++i) {
    r0[i] = point_difference<K, T>(query.p0, i);
    r1[i] = point_difference<K, T>(query.p1, i);
  }
  if (detail::out_of_range<K>(r0, r1)) return true;
  if (separated_by_axis<K>(r0, r1, static_cast<T>(separation))) return false;
  return !volume_cubic(volume_vectors<K, T>(query)).certainly_nonzero();
}

namespace detail {

/// Directions that separate for a shorter time than this come from gaps full of rounding errors.
inline constexpr double kShort = 0x1p-30;

/// The time at which the front stopped (`time` > 1: it passed), and the step that moved it there.
template <class N>
struct Front {
  N time;
  N w[4]{};           // weights of the closest points at `time`
  bool clear{false};  // a plain crossing in the interior of both primitives: surely a contact

  // The next three tell the side from which the pair comes, by the last step that took longer than
  // kShort.
  N since{};       // where that step started
  double side{};   // sign of the volume on it, or 0:
  Vec3<N> last{};  // a direction that separated the pair on it
};

/// True when f certainly changes its sign within kCrossingTime before and after t.
template <class N>
ICLOTH_HD bool crosses_at(const Bernstein3<N>& f, N t) {
  const N near = N(kCrossingTime);
  return f.certain_sign(larger(t - near, N(0))) * f.certain_sign(smaller(t + near, N(1))) < 0;
}

/// The end of separation by the features of the boundary, where the points of the front's weights
/// do not touch already, and its direction in d. Where there is none, the weights of the front are
/// mended.
template <PairKind K, class N>
[[gnu::noinline, gnu::cold]] ICLOTH_HD N separated_at_collapse_until(const PairMotion<K, N>& pair,
                                                                     double margin, Front<N>& front,
                                                                     Vec3<N>& d) {
  if (touches(pair, front.time, front.w)) return front.time;
  const N end = separated_by_boundary_until(pair, margin, front.time, d);
  if (!(end > front.time)) mend_weights(pair, front.time, front.w);
  return end;
}

/// Moves the front in time by the two kinds of steps that the head of this file describes, until it
/// passes 1 or no direction separates the pair.
template <PairKind K, class N>
ICLOTH_HD void advance(const PairMotion<K, N>& pair, const Bernstein3<N>& f, double margin,
                       Front<N>& front) {
  const N least_step = N(64) * kRoundoff<N>;  // less than this is no progress
  for (int step = 0; step < kMaxSteps; ++step) {
    // The first kind of step goes up to the first time at which the four points may be coplanar.
    const N start = front.time;
    front.time = first_zero_bound(f, start);
    if (front.time > N(1)) return;
    if (front.time - start > N(kShort)) {
      front.since = start;
      front.side = f.certain_sign(start);
    }

    // A plain crossing in the interior of both primitives is a contact; no direction need be tried.
    const ClosestPair<N> closest = closest_pair(pair, front.time);
    for (int k = 0; k < 4; ++k) front.w[k] = closest.w[k];
    front.clear =
        !closest.doubtful && crosses_at(f, front.time) && certainly_inside(pair, closest.depth);
    if (front.clear) return;

    // The second kind of step goes on for as long as some direction separates the pair. The
    // candidates are those of the closest features first, then the axes.
    const N needed = front.time + least_step;
    Vec3<N> direction = closest.first;
    N end = separated_until(pair, direction, margin, front.time);
    if (end < needed && closest.doubtful) {
      direction = closest.second;
      end = separated_until(pair, direction, margin, front.time);
    }
    if (end < needed) end = separated_by_axes_until(pair, margin, front.time, direction);

    // At an instant of collapse the closest features may be the wrong ones, and all those of the
    // boundary are tried.
    if (end < needed) end = separated_at_collapse_until(pair, margin, front, direction);
    if (end < needed) return;

    // Many short steps are a sign of edges that turn past a point, and a side of the edge serves.
    // This is left to the finer front, since it would slow down the code for all other pairs.
    if constexpr (sizeof(N) == sizeof(DoubleDouble)) {
      if (step >= kFirstTurningStep && !(margin > 0)) {
        end = separated_in_view_until(pair, front.time, end, direction);
      }
    }

    // A step that took long enough tells the side from which the pair comes.
    if (end - front.time > N(kShort)) {
      front.since = front.time;
      front.side = 0;
      front.last = direction;
    }
    front.time = end;
    if (end > N(1)) return;
  }
}

/// The unit normal at the contact, towards the side from which the pair comes.
template <PairKind K>
ICLOTH_HD Vec3d contact_normal(const PairMotion<K, double>& pair, const VolumeVectors<double>& v,
                               const Front<double>& front) {
  const double t = front.time;
  const Vec3d b = (1 - t) * v.b0 + t * v.b1, c = (1 - t) * v.c0 + t * v.c1, n = cross(b, c);
  const bool plane = norm2(n) > 1e-16 * norm2(b) * norm2(c);

  // The volume is n·gap, and its sign just before the contact is certain.
  if (front.side != 0 && plane) return normalized(front.side * n);
  if (front.side == 0 && norm2(front.last) > 0) return normalized(front.last);

  // For parallel edges or a sliver the direction of the gap shortly before serves.
  const double before = t - 0.05 * (t - front.since);
  const ClosestPair<double> closest = closest_pair(pair, before);
  Vec3d r[kDifferences<K>];
  for (int i = 0; i < kDifferences<K>; ++i) r[i] = pair.at(before, i);
  const Vec3d gap = normalized(weighted_gap<K>(closest.w, r));
  if (t - front.since > kShort && norm2(gap) > 0) return gap;

  // The pair was in touch from the start and no side is known, so the normal opposes the relative
  // motion.
  const Vec3d motion = weighted_gap<K>(front.w, pair.r1) - weighted_gap<K>(front.w, pair.r0);
  const Vec3d any = normalized(plane ? n : -motion);
  if (!(norm2(any) > 0)) return {0, 1, 0};
  return dot(any, motion) > 0 ? -any : any;
}

/// The contact that is reported for numbers out of range: at once, at the middle of both
/// primitives.
template <PairKind K>
ICLOTH_HD CcdHit undecidable() {
  if (K == PairKind::ee) return {0, {-0.5, -0.5, 0.5, 0.5}, {0, 1, 0}};
  return {0, {1, -1. / 3, -1. / 3, -1. / 3}, {0, 1, 0}};
}

/// Goes on in double-double arithmetic from where fp64 stopped. Returns true when the contact
/// stands.
template <PairKind K>
ICLOTH_HD bool confirm(const CcdQuery<double>& query, double margin, bool coplanar,
                       Front<double>& front) {
  const PairMotion<K, DoubleDouble> pair(query);
  const Bernstein3<DoubleDouble> f(volume_cubic(volume_vectors<K, DoubleDouble>(query)));
  Front<DoubleDouble> fine{front.time};
  fine.since = front.time;
  advance(pair, f, margin, fine);
  if (fine.time > DoubleDouble(1)) return false;

  // A coplanar pair keeps the directions in its plane, unless the finer front has left them behind:
  // those of the finer front come from a plane that rounding made up.
  if (coplanar && !(fine.time - DoubleDouble(front.time) > DoubleDouble(kShort))) return true;

  // The time is rounded down, and the side of the approach is taken over where the finer front
  // found one.
  front.time = fine.time.hi;
  if (fine.time.lo < 0) front.time *= 1 - 0x1p-52;  // rounds down
  for (int k = 0; k < 4; ++k) front.w[k] = fine.w[k].hi;
  if (fine.side != 0 || norm2(rounded(fine.last)) > 0) {
    front.since = fine.since.hi;
    front.side = fine.side;
    front.last = rounded(fine.last);
  }
  return true;
}

template <PairKind K, class T>
ICLOTH_HD bool elementary_ccd(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  // Single precision filters first, since fp64 is slow on most GPUs.
  if (sizeof(T) == 4 && !ccd_filter<K>(query, separation)) return false;

  // Numbers that no bound covers count as a contact, and the two cheap tests in double precision
  // follow.
  const PairMotion<K, double> pair(query);
  if (out_of_range<K>(pair.r0, pair.r1)) {
    hit = undecidable<K>();
    return true;
  }
  if (separated_by_axis<K>(pair.r0, pair.r1, separation)) return false;
  const VolumeVectors<double> volume = volume_vectors<K, double>(query);
  const VolumeCubic<double> cubic = volume_cubic(volume);
  if (cubic.certainly_nonzero()) return false;

  const Bernstein3<double> f(cubic);
  const bool coplanar = f.vanishes();
  const double margin = coplanar ? separation : 0;

  // The front in time decides. Where it stopped without a clear crossing and the input is double,
  // double-double arithmetic goes on.
  Front<double> front{0};
  advance(pair, f, margin, front);
  if (front.time > 1) return false;
  if constexpr (sizeof(T) == 8) {
    if (!front.clear && !confirm<K>(query, margin, coplanar, front)) return false;
  }

  // The front stopped: its time and weights are the contact.
  hit.toi = front.time;
  for (int k = 0; k < 4; ++k) hit.w[k] = front.w[k];
  hit.normal = contact_normal(pair, volume, front);
  return true;
}

}  // namespace detail

/// Tests a vertex against a face. On true, `hit` holds the first contact. `separation` [length] is
/// the gap below which pairs that stay coplanar throughout count as touching; with 0 only pairs
/// that touch are reported.
template <class T>
ICLOTH_HD bool ccd_vf(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  return detail::elementary_ccd<PairKind::vf>(query, separation, hit);
}

/// Tests an edge against an edge; the arguments are those of ccd_vf.
template <class T>
ICLOTH_HD bool ccd_ee(const CcdQuery<T>& query, double separation, CcdHit& hit) {
  return detail::elementary_ccd<PairKind::ee>(query, separation, hit);
}

}  // namespace icloth
