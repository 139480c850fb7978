// The input and the output of the finders of candidate pairs.
#pragma once

#include "kernels/box.h"
#include "kernels/parallel/parallel.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// Boxes of the elements, those of cloths first.
struct ElementBoxes {
  MovingBoxes vertex, face, edge;
};

/// Pairs that share no vertex, that do not stay apart, and of which at least one element is of a
/// cloth; each is listed once, in any order.
struct Candidates {
  Array<Pair> vertex_faces;    ///< (vertex, face)
  Array<Pair> edge_edges;      ///< (edge, edge), the smaller edge first
  std::int64_t box_tests = 0;  ///< boxes compared since it was cleared; only where asked for

  void clear() {
    vertex_faces.resize(0);
    edge_edges.resize(0);
    box_tests = 0;
  }
};

/// Copies pairs behind those of a list.
struct CopyPairs {
  View<const Pair> from;
  View<Pair> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[i]; }
};
inline void append_pairs(const Array<Pair>& from, Array<Pair>& to) {
  const Index old = to.size();
  to.resize_keep(old + from.size());
  for_each("broad_phase.append", from.size(),
           CopyPairs{from.view(), to.view().sub(old, from.size())});
}

ICLOTH_HD inline bool has_vertex(const Int3& face, Index v) {
  return face.v[0] == v || face.v[1] == v || face.v[2] == v;
}
ICLOTH_HD inline bool share_vertex(const Int2& p, const Int2& q) {
  return p.v[0] == q.v[0] || p.v[0] == q.v[1] || p.v[1] == q.v[0] || p.v[1] == q.v[1];
}
ICLOTH_HD inline Pair ordered_pair(Index a, Index b) { return a < b ? Pair{a, b} : Pair{b, a}; }

/// Tells which elements have a dirty vertex; obstacles have none.
struct DirtyVertices {
  View<const std::uint8_t> flag;  ///< (cloth_vertices)
  ICLOTH_HD bool operator()(Index v) const { return v < flag.size() && flag[v] != 0; }
};
struct DirtyFaces {
  DirtyVertices dirty;
  View<const Int3> face;
  ICLOTH_HD bool operator()(Index f) const {
    const Int3& t = face[f];
    return dirty(t.v[0]) || dirty(t.v[1]) || dirty(t.v[2]);
  }
};
struct DirtyEdges {
  DirtyVertices dirty;
  View<const Int2> edge;
  ICLOTH_HD bool operator()(Index e) const { return dirty(edge[e].v[0]) || dirty(edge[e].v[1]); }
};

/// Tells which pairs have a dirty vertex.
struct DirtyVertexFace {
  DirtyVertices vertex;
  DirtyFaces face;
  ICLOTH_HD bool operator()(Pair p) const { return vertex(p.a) || face(p.b); }
};
struct DirtyEdgeEdge {
  DirtyEdges edge;
  ICLOTH_HD bool operator()(Pair p) const { return edge(p.a) || edge(p.b); }
};

/// Copies the picked pairs.
struct PickPairs {
  View<const Pair> from;
  View<const Index> picked;
  View<Pair> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[picked[i]]; }
};

}  // namespace icloth::ICLOTH_BUILD
