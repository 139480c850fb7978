#include "sim/collision/tree_pairs.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Counts the boxes that a query compares with, without emitting anything.
template <class Query>
struct CountTests {
  Query query;
  ICLOTH_HD std::int64_t operator()(Index i) const {
    const auto ignore = [](const Pair&) {};
    return query(i, ignore);
  }
};

/// Finds the (vertex, face) candidates of one vertex against one tree.
struct VertexFaceQuery {
  TreeView tree;
  MovingBoxes vertex_box, face_box;
  View<const Int3> face;
  View<const Index> list;  ///< query vertices; null: from `first` on
  Index first;

  template <class Emit>
  ICLOTH_HD Index operator()(Index i, Emit& emit) const {
    const Index v = list.data() == nullptr ? first + i : list[i];
    const MovingBox own = vertex_box.at(v);
    return query_tree(tree, own.swept(), kNone, [&](Index, Index f) {
      if (!has_vertex(face[f], v) && !stay_apart(own, face_box, f)) emit(Pair{v, f});
    });
  }
};

/// Finds the candidates of a vertex that is not dirty; those that are dirty have queried already.
struct CleanVertexQuery {
  VertexFaceQuery query;
  DirtyVertices dirty;

  template <class Emit>
  ICLOTH_HD Index operator()(Index v, Emit& emit) const {
    return dirty(v) ? 0 : query(v, emit);
  }
};

/// Finds the (edge, edge) candidates of one cloth edge against one tree. In its own tree an edge
/// meets only the leaves after its own, so that each pair is found once.
struct EdgeEdgeQuery {
  TreeView tree;
  View<const Index> order;  ///< query edges in leaf order
  MovingBoxes box;
  View<const Int2> edge;
  bool own_tree;

  template <class Emit>
  ICLOTH_HD Index operator()(Index leaf, Emit& emit) const {
    const Index e = order[leaf];
    const MovingBox own = box.at(e);
    const Int2 ends = edge[e];
    return query_tree(tree, own.swept(), own_tree ? leaf : kNone, [&](Index, Index other) {
      if (!share_vertex(ends, edge[other]) && !stay_apart(own, box, other))
        emit(ordered_pair(e, other));
    });
  }
};

/// Finds the candidates of a dirty edge; a pair of two dirty edges is found from the smaller one.
struct DirtyEdgeQuery {
  TreeView tree;
  View<const Index> list;
  MovingBoxes box;
  DirtyEdges dirty;

  template <class Emit>
  ICLOTH_HD Index operator()(Index i, Emit& emit) const {
    const Index e = list[i];
    const MovingBox own = box.at(e);
    return query_tree(tree, own.swept(), kNone, [&](Index, Index other) {
      if (e > other && dirty(other)) return;
      if (!share_vertex(dirty.edge[e], dirty.edge[other]) && !stay_apart(own, box, other))
        emit(ordered_pair(e, other));
    });
  }
};

}  // namespace

void TreePairs::update(const Topology& mesh, const ElementBoxes& boxes, bool rebuild) {
  // A tree over a range keeps the boxes before it, as its items are numbered by the whole list.
  const auto update = [&](Tree& tree, const MovingBoxes& all, Index first, Index last) {
    const MovingBoxes upto = all.sub(0, last);
    if (rebuild)
      tree.build(upto, first);
    else
      tree.refit(upto);
  };

  update(cloth_faces_, boxes.face, 0, mesh.cloth_faces);
  update(cloth_edges_, boxes.edge, 0, mesh.cloth_edges);
  update(obstacle_faces_, boxes.face, mesh.cloth_faces, mesh.faces);
  update(obstacle_edges_, boxes.edge, mesh.cloth_edges, mesh.edges);
}

/// Appends the candidates that a query finds.
template <class Query>
void TreePairs::run(const char* name, Index count, const Query& query, Array<Pair>& list,
                    Candidates& out) {
  if (count == 0) return;
  collect(name, count, query, found_);

  if (count_tests)
    out.box_tests +=
        reduce("broad_phase.count", count, std::int64_t{0}, CountTests<Query>{query}, Sum{});
  append_pairs(found_, list);
}

void TreePairs::find(const Topology& mesh, const ElementBoxes& boxes, Candidates& out) {
  // Every vertex of the cloth is compared with all faces; those of obstacles with the cloth's
  // alone.
  const auto vertices_against = [&](const Tree& tree, Index first, Index count) {
    if (tree.empty()) return;
    run("broad_phase.vertex_face", count,
        VertexFaceQuery{tree.view(), boxes.vertex, boxes.face, mesh.face.view(), {}, first},
        out.vertex_faces, out);
  };
  vertices_against(cloth_faces_, 0, mesh.cloth_vertices);
  vertices_against(obstacle_faces_, 0, mesh.cloth_vertices);
  vertices_against(cloth_faces_, mesh.cloth_vertices, mesh.vertices - mesh.cloth_vertices);

  // Every edge of the cloth is compared with later cloth edges and with all edges of obstacles.
  for (const Tree* tree : {&cloth_edges_, &obstacle_edges_}) {
    if (tree->empty()) continue;
    run("broad_phase.edge_edge", mesh.cloth_edges,
        EdgeEdgeQuery{tree->view(), cloth_edges_.view().items, boxes.edge, mesh.edge.view(),
                      tree == &cloth_edges_},
        out.edge_edges, out);
  }
}

void TreePairs::find_dirty(const Topology& mesh, const ElementBoxes& boxes,
                           View<const std::uint8_t> dirty, Candidates& out) {
  const DirtyVertices dirty_vertex{dirty};
  const DirtyEdges dirty_edge{dirty_vertex, mesh.edge.view()};

  // The dirty elements are listed first.
  compact("broad_phase.dirty", mesh.cloth_vertices, dirty_vertex, dirty_vertices_);
  compact("broad_phase.dirty", mesh.cloth_faces, DirtyFaces{dirty_vertex, mesh.face.view()},
          dirty_faces_);
  compact("broad_phase.dirty", mesh.cloth_edges, dirty_edge, dirty_edges_);

  // Dirty vertices are compared with all faces.
  for (const Tree* tree : {&cloth_faces_, &obstacle_faces_}) {
    if (tree->empty()) continue;
    run("broad_phase.vertex_face", dirty_vertices_.size(),
        VertexFaceQuery{tree->view(), boxes.vertex, boxes.face, mesh.face.view(),
                        dirty_vertices_.view(), 0},
        out.vertex_faces, out);
  }

  // The clean vertices meet the dirty faces only, in a tree of their own.
  dirty_face_tree_.build(boxes.face, dirty_faces_.view());
  if (!dirty_face_tree_.empty())
    run("broad_phase.vertex_face", mesh.vertices,
        CleanVertexQuery{
            {dirty_face_tree_.view(), boxes.vertex, boxes.face, mesh.face.view(), {}, 0},
            dirty_vertex},
        out.vertex_faces, out);

  // Dirty edges are compared with all edges.
  for (const Tree* tree : {&cloth_edges_, &obstacle_edges_}) {
    if (tree->empty()) continue;
    run("broad_phase.edge_edge", dirty_edges_.size(),
        DirtyEdgeQuery{tree->view(), dirty_edges_.view(), boxes.edge, dirty_edge}, out.edge_edges,
        out);
  }
}

}  // namespace icloth::ICLOTH_BUILD
