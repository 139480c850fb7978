// Pairs near an instant at which a face or an edge collapses: a face to a line, a segment or a
// point, an edge to a point, or two edges to parallel ones.
//
// There the volume changes its sign although the primitives may be far apart, because it is the
// area that passes through zero and not the gap. Weights and normals mean little near such an
// instant: the face is small or thin against the rounding errors of its points. Two answers follow.
//   - A change of sign is a contact where the weights stay inside the primitives throughout the
//     time that it takes (certainly_inside). A collapse never fulfils this.
//   - A pair that is apart is separated by the direction between its closest features. The features
//     of the boundary (points, and points against edges) give these directions even where the
//     normal is lost (separated_by_boundary_until).
#pragma once

#include "kernels/ccd/ccd_closest.h"
#include "kernels/ccd/ccd_first_zero.h"

namespace icloth {

/// A change of the volume's sign is looked for within this time before and after the front.
inline constexpr double kCrossingTime = 0x1p-38;

/// True when the closest points, found at some time inside both primitives with the given `depth`
/// (ClosestPair), certainly stay inside for kCrossingTime before and after it, and the primitives
/// keep an area or an angle. A volume that changes its sign meanwhile then proves a contact.
///
/// Let n = b×c as in ccd_cubic.h, q any of the differences, and β, γ, ρ bounds of |b|, |c| and |q|
/// over [0,1]. The weights times |n|², and |n|² minus those, are sums of terms (q×c)·n, (b×q)·n and
/// n·n, so that βγ (βγ + ρβ + ργ) bounds the terms of each. Every term is linear in four vectors,
/// each of which changes by at most 2 kCrossingTime of its bound; together that is 2⁻³⁵ of the
/// term. The rounding of b and c at a time is under 9·2⁻⁵³ ρ. Raising β and γ by 2⁻¹² ρ makes it
/// 2⁻³⁷ of their bounds, hence 2⁻³⁵ of the term. A bound of a norm is √3 times the largest
/// component, to the fourth power 9, and 9 · 2⁻³⁴ < 2⁻³⁰.
template <PairKind K, class N>
ICLOTH_HD bool certainly_inside(const PairMotion<K, N>& pair, N depth) {
  // No component of b and c exceeds twice the largest of the differences, which settles most pairs.
  const N reach = detail::larger(detail::larger(pair.size.x, pair.size.y), pair.size.z);
  const N underflow = N(1e-290);
  if (depth > N(0x1p-24) * (reach * reach) * (reach * reach) + underflow) return true;

  // Otherwise their own components count.
  const Vec3<N>*r0 = pair.r0, *r1 = pair.r1;
  const N rounding = N(0x1p-12) * reach;
  const N b = detail::largest_component(r0[1] - r0[0], r1[1] - r1[0]) + rounding;
  const N c = detail::largest_component(r0[2] - r0[0], r1[2] - r1[0]) + rounding;
  return depth > N(0x1p-30) * (b * c) * (b * c + reach * (b + c)) + underflow;
}

/// The vector of the gap for the weights w, from the differences r of the pair at one time.
template <PairKind K, class N>
ICLOTH_HD Vec3<N> weighted_gap(const N* w, const Vec3<N>* r) {
  Vec3<N> gap;
  for (int i = 0; i < kDifferences<K>; ++i) {
    const N share = K == PairKind::vf ? -w[1 + i] : -w[2 + i / 2] * w[i % 2];
    gap += share * r[i];
  }
  return gap;
}

/// True when the points of weights w touch at time t up to rounding, so that no direction separates
/// the pair there. The points belong to the primitives, however badly the weights were computed.
template <PairKind K, class N>
ICLOTH_HD bool touches(const PairMotion<K, N>& pair, N t, const N* w) {
  Vec3<N> r[kDifferences<K>];
  for (int i = 0; i < kDifferences<K>; ++i) r[i] = pair.at(t, i);
  const N rounding = N(64) * kRoundoff<N>;
  return !(norm2(weighted_gap<K>(w, r)) > rounding * rounding * norm2(pair.size));
}

namespace detail {

/// Number of edges that lie opposite to a point of the other primitive: three edges of the face to
/// the vertex, or either edge to both ends of the other one.
template <PairKind K>
inline constexpr int kOppositeEdges = K == PairKind::vf ? 3 : 4;

/// The differences from the point to the two ends of opposite edge k. For ee the edges are a seen
/// from b0 and from b1, then b seen from a0 and from a1.
struct EdgeEnds {
  int first, second;
};
template <PairKind K>
ICLOTH_HD EdgeEnds opposite_edge(int k) {
  if constexpr (K == PairKind::vf) return {k, (k + 1) % 3};
  return k < 2 ? EdgeEnds{2 * k, 2 * k + 1} : EdgeEnds{k - 2, k};
}

/// The weights of the point at parameter s of opposite edge k, and of the point opposite to it.
template <PairKind K, class N>
ICLOTH_HD void set_boundary_weights(int k, N s, N* w) {
  for (int i = 0; i < 4; ++i) w[i] = N(0);
  if constexpr (K == PairKind::vf) {
    w[0] = N(1);
    w[1 + k] = s - N(1);
    w[1 + (k + 1) % 3] = -s;
  } else if (k < 2) {
    w[0] = s - N(1);
    w[1] = -s;
    w[2 + k] = N(1);
  } else {
    w[k - 2] = N(-1);
    w[2] = N(1) - s;
    w[3] = s;
  }
}

}  // namespace detail

/// The latest end of separation over the directions between the features of the two boundaries at
/// time t, and its direction in d: all differences of points, and their parts perpendicular to the
/// opposite edges. Where an edge has collapsed its direction is lost, and the difference of the
/// points serves.
template <PairKind K, class N>
ICLOTH_HD N separated_by_boundary_until(const PairMotion<K, N>& pair, double margin, N t,
                                        Vec3<N>& d) {
  N best = t;
  for (int k = 0; k < kDifferences<K> + detail::kOppositeEdges<K>; ++k) {
    // The shorter of the two differences to an edge loses less to rounding.
    Vec3<N> direction;
    if (k < kDifferences<K>) {
      direction = pair.at(t, k);
    } else {
      const detail::EdgeEnds edge = detail::opposite_edge<K>(k - kDifferences<K>);
      const Vec3<N> x = pair.at(t, edge.first), y = pair.at(t, edge.second);
      direction = detail::orthogonal_to(norm2(x) < norm2(y) ? x : y, y - x);
    }

    // The certificate does not depend on how well the direction was computed.
    const N end = separated_until(pair, direction, margin, t);
    if (!(end > best)) continue;
    best = end;
    d = direction;
  }
  return best;
}

/// Extends a separation that lasts from t to `end` by looking at the pair along a fixed direction
/// m: the later of `end` and the time until which the primitives are certainly apart as seen along
/// m. Where it is later, d becomes the direction that separates them shortly before it.
///
/// Seen along m, a point lies on one side of the line of an opposite edge while m·(x×y) keeps its
/// sign, x and y being the differences to the ends of the edge; that is a volume, with m for its
/// third vector. A point is outside a triangle while two edges have it on different sides, and two
/// edges are apart while both ends of one lie on the same side of the other. These lines turn with
/// the edges, so that pairs that stay coplanar move on where fixed directions end after short
/// times.
template <PairKind K, class N>
[[gnu::noinline, gnu::cold]] ICLOTH_HD N separated_in_view_until(const PairMotion<K, N>& pair, N t,
                                                                 N end, Vec3<N>& d) {
  // The view is along the normal of a plane through a point and an opposite edge. The largest of
  // these normals is the least disturbed by rounding.
  constexpr int kEdges = detail::kOppositeEdges<K>;
  Vec3<N> m;
  for (int k = 0; k < kEdges; ++k) {
    const detail::EdgeEnds edge = detail::opposite_edge<K>(k);
    const Vec3<N> normal = cross(pair.at(t, edge.first), pair.at(t, edge.second));
    if (norm2(m) < norm2(normal)) m = normal;
  }

  // Each side is certain up to some time.
  N until[kEdges];
  double sign[kEdges];
  for (int k = 0; k < kEdges; ++k) {
    const detail::EdgeEnds edge = detail::opposite_edge<K>(k);
    const Bernstein3<N> side(
        volume_cubic(VolumeVectors<N>{pair.r0[edge.first], pair.r0[edge.second], m,
                                      pair.r1[edge.first], pair.r1[edge.second], m}));
    until[k] = first_zero_bound(side, t);
    sign[k] = side.certain_sign(t);
  }

  // Two sides prove the separation: different ones of the face, or equal ones of an edge from both
  // ends of the other, which are neighbours in the numbering.
  int first_to_end = -1;
  for (int i = 0; i < kEdges; ++i) {
    for (int j = i + 1; j < kEdges; ++j) {
      const double product = sign[i] * sign[j];
      if (!(K == PairKind::vf ? product < 0 : i / 2 == j / 2 && 0 < product)) continue;
      const int k = until[j] < until[i] ? j : i;
      if (first_to_end < 0 || until[first_to_end] < until[k]) first_to_end = k;
    }
  }
  if (first_to_end < 0 || !(until[first_to_end] > end)) return end;

  // At the end a point reaches the line of this edge. Where the rest lies beyond it, which one look
  // shortly before tells, the perpendicular to the edge is the direction that separates there.
  const detail::EdgeEnds edge = detail::opposite_edge<K>(first_to_end);
  end = until[first_to_end];
  const N before = end - N(0x1p-10) * (end - t);
  const Vec3<N> along = pair.at(before, edge.second) - pair.at(before, edge.first);
  const Vec3<N> across = sign[first_to_end] > 0 ? cross(along, m) : cross(m, along);
  if (separated_until(pair, across, 0, before) > before) d = across;
  return end;
}

/// Replaces weights that rounding has spoilt, which shows in a gap of more than 2⁻²⁰ of the extent,
/// by those of the closest points on the boundary where these are closer.
template <PairKind K, class N>
ICLOTH_HD void mend_weights(const PairMotion<K, N>& pair, N t, N* w) {
  Vec3<N> r[kDifferences<K>];
  for (int i = 0; i < kDifferences<K>; ++i) r[i] = pair.at(t, i);
  N least = norm2(weighted_gap<K>(w, r));
  if (!(least > N(0x1p-40) * norm2(pair.size))) return;

  // Every opposite edge offers its point that is closest to the point opposite to it.
  for (int k = 0; k < detail::kOppositeEdges<K>; ++k) {
    const detail::EdgeEnds edge = detail::opposite_edge<K>(k);
    const N s = closest_on_segment(Vec3<N>{}, r[edge.first], r[edge.second]);
    const N distance2 = norm2((N(1) - s) * r[edge.first] + s * r[edge.second]);
    if (!(distance2 < least)) continue;
    least = distance2;
    detail::set_boundary_weights<K>(k, s, w);
  }
}

}  // namespace icloth
