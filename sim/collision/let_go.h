// The stages look up here which cloth vertices are let go from a body (sim/collision/pinch.h).
#pragma once

#include "kernels/parallel/partition_point.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

struct LetGoView {
  View<const LetGo> list;  ///< sorted by vertex and body
  View<const Index> object;
  Index cloth_vertices = 0;

  ICLOTH_HD bool holds(Index vertex, Index body) const {
    const Index k = partition_point(list.size(), [&](Index i) {
      return list[i].vertex != vertex ? list[i].vertex < vertex : list[i].body < body;
    });
    return k < list.size() && list[k].vertex == vertex && list[k].body == body;
  }

  /// True for a pair of cloth and body when one of its cloth vertices is let go from that body.
  ICLOTH_HD bool ignores(const Index v[4]) const {
    if (list.size() == 0) return false;
    Index body = -1;
    for (int a = 0; a < 4; ++a)
      if (v[a] >= cloth_vertices) body = object[v[a]];
    if (body < 0) return false;
    for (int a = 0; a < 4; ++a)
      if (v[a] < cloth_vertices && holds(v[a], body)) return true;
    return false;
  }
};

inline LetGoView let_go_view(const State& state, const Topology& mesh) {
  return {state.let_go.view(), mesh.object.view(), mesh.cloth_vertices};
}

}  // namespace icloth::ICLOTH_BUILD
