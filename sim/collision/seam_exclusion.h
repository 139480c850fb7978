// The stages look up here which elements face each other across an open seam.
#pragma once

#include "kernels/parallel/partition_point.h"
#include "sim/scene/seam_pairs.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// Elements of the two sides of a seam do not repel each other and may come as near as δ_s, or the
/// seam could not close. Continuous collision detection keeps them from passing through each other.
struct SeamView {
  View<const Index> first;  ///< see SeamNeighbours; empty: no open seam
  View<const Index> vertex;

  ICLOTH_HD bool joins(Index a, Index b) const {
    if (a + 1 >= first.size()) return false;
    const Index begin = first[a], count = first[a + 1] - begin;
    const Index k = partition_point(count, [&](Index i) { return vertex[begin + i] < b; });
    return k < count && vertex[begin + k] == b;
  }

  /// Whether one element has a vertex in the ring around one side of a stitched pair, and the other
  /// element one in the ring around the other side.
  ICLOTH_HD bool holds(bool edge_edge, const Index v[4]) const {
    if (first.size() == 0) return false;
    const int split = edge_edge ? 2 : 1;  // the first element has so many vertices
    for (int i = 0; i < split; ++i)
      for (int j = split; j < 4; ++j)
        if (joins(v[i], v[j])) return true;
    return false;
  }

  /// δ of a pair of elements, or a length in proportion to it.
  ICLOTH_HD double offset(bool edge_edge, const Index v[4], double usual) const {
    return holds(edge_edge, v) ? std::fmin(usual, kSeamOffset) : usual;
  }
};

inline SeamView seam_view(const Topology& mesh) {
  return {mesh.seam_neighbour_first.view(), mesh.seam_neighbour.view()};
}

}  // namespace icloth::ICLOTH_BUILD
