// How far apart the two elements of a contact are at rest.
#pragma once

#include "kernels/stencil.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// Measures gaps at rest: in space or in the plane of a panel, and across seams by the distances of
/// the vertices around them.
struct RestGap {
  View<const Vec3r> rest;
  View<const Index> panel;  ///< empty where no cloth is sewn of panels
  View<const Index> seam_first;
  View<const SeamDistance> seam;

  /// Square of the gap Σ w_a x_a of a stencil of one cloth, whose weights sum up to 0 [m²];
  /// infinite where its vertices are farther apart than the lists reach.
  ICLOTH_HD Real norm2_of(const Stencil& s) const {
    if (panel.size() == 0 || of_one_panel(s)) return norm2(apply(s, rest));

    // |Σ w_a x_a|² = −Σ w_a w_b |x_a − x_b|² over all pairs: no coordinates are needed.
    Real sum = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) {
        const Real squared = distance2(s.v[a], s.v[b]);
        if (squared < 0) return kFar;
        sum -= s.w[a] * s.w[b] * squared;
      }
    return sum;
  }

 private:
  static constexpr Real kFar = static_cast<Real>(1e30);

  /// Whether all four vertices lie inside one panel, away from seams.
  ICLOTH_HD bool of_one_panel(const Stencil& s) const {
    const Index first = panel[s.v[0]];
    bool same = first != kNone;
    for (int a = 1; a < 4; ++a) same = same && panel[s.v[a]] == first;
    return same;
  }

  /// Square of the distance of two vertices; −1: not known, and far.
  ICLOTH_HD Real distance2(Index i, Index j) const {
    const Index low = i < j ? i : j, high = i < j ? j : i;
    for (Index k = seam_first[low]; k < seam_first[low + 1]; ++k)
      if (seam[k].vertex == high) return seam[k].squared;
    if (panel[i] == kNone || panel[i] != panel[j]) return -1;
    return norm2(rest[i] - rest[j]);
  }
};

}  // namespace icloth::ICLOTH_BUILD
