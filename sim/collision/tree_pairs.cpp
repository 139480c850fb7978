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

/// The elements of one query, which follow each other in a list. A query is for as many of them as
/// descend a tree together.
template <class Group>
struct QueryElements {
  View<const Index> list;
  MovingBoxes box;

  ICLOTH_HD Index first(Index query) const { return query * Group::kWidth; }
  ICLOTH_HD Group group(Index query) const {
    const Index begin = first(query), left = list.size() - begin;
    Group own;
    for (Index m = 0; m < Group::kWidth && m < left; ++m) own.set(m, box.at(list[begin + m]));
    return own;
  }
};

/// No leaf is left out for any member of a query.
template <class Group>
constexpr Index kAllLeaves = kNone - Group::kWidth;

/// Finds the (vertex, face) candidates of vertices against one tree.
template <class Group>
struct VertexFaceQuery {
  using GroupType = Group;
  TreeView tree;
  QueryElements<Group> vertex;
  View<const Int3> face;
  DirtyVertices but;  ///< vertices that have queried already

  template <class Emit>
  ICLOTH_HD Index operator()(Index query, Emit& emit) const {
    const Index first = vertex.first(query);
    return query_tree(tree, vertex.group(query), kAllLeaves<Group>, [&](Index member, Index f) {
      const Index v = vertex.list[first + member];
      if (!has_vertex(face[f], v) && !but(v)) emit(Pair{v, f});
    });
  }
};

/// Finds the (edge, edge) candidates of cloth edges against one tree. In its own tree an edge meets
/// only the leaves after its own, so that each pair is found once.
struct EdgeEdgeQuery {
  using GroupType = Neighbours;
  TreeView tree;
  QueryElements<Neighbours> own;  ///< in leaf order
  View<const Int2> edge;
  bool own_tree;

  template <class Emit>
  ICLOTH_HD Index operator()(Index query, Emit& emit) const {
    const Index first = own.first(query);
    const Index after = own_tree ? first : kAllLeaves<Neighbours>;
    return query_tree(tree, own.group(query), after, [&](Index member, Index other) {
      const Index e = own.list[first + member];
      if (!share_vertex(edge[e], edge[other])) emit(ordered_pair(e, other));
    });
  }
};

/// Finds the candidates of a dirty edge; a pair of two dirty edges is found from the smaller one.
struct DirtyEdgeQuery {
  using GroupType = OneElement;
  TreeView tree;
  QueryElements<OneElement> own;
  DirtyEdges dirty;

  template <class Emit>
  ICLOTH_HD Index operator()(Index query, Emit& emit) const {
    const Index e = own.list[query];
    return query_tree(tree, own.group(query), kAllLeaves<OneElement>, [&](Index, Index other) {
      if (e > other && dirty(other)) return;
      if (!share_vertex(dirty.edge[e], dirty.edge[other])) emit(ordered_pair(e, other));
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

  // Vertices have no tree and only query others.
  if (!rebuild) return;
  cloth_vertices_.sort(boxes.vertex.sub(0, mesh.cloth_vertices), 0);
  obstacle_vertices_.sort(boxes.vertex, mesh.cloth_vertices);
}

/// Appends the candidates that the queries of some elements find.
template <class Query>
void TreePairs::run(const char* name, Index elements, const Query& query, Array<Pair>& list,
                    Candidates& out) {
  constexpr Index width = Query::GroupType::kWidth;
  const Index queries = (elements + width - 1) / width;
  if (queries == 0) return;
  collect(name, queries, query, found_);

  if (count_tests)
    out.box_tests +=
        reduce("broad_phase.count", queries, std::int64_t{0}, CountTests<Query>{query}, Sum{});
  append_pairs(found_, list);
}

void TreePairs::find(const Topology& mesh, const ElementBoxes& boxes, Candidates& out) {
  // Every vertex of the cloth is compared with all faces; those of obstacles with the cloth's
  // alone.
  const auto vertices_against = [&](const Tree& tree, const CurveOrder& vertices) {
    if (tree.empty()) return;
    run("broad_phase.vertex_face", vertices.size(),
        VertexFaceQuery<Neighbours>{
            tree.view(), {vertices.view(), boxes.vertex}, mesh.face.view(), {}},
        out.vertex_faces, out);
  };
  vertices_against(cloth_faces_, cloth_vertices_);
  vertices_against(obstacle_faces_, cloth_vertices_);
  vertices_against(cloth_faces_, obstacle_vertices_);

  // Every edge of the cloth is compared with later cloth edges and with all edges of obstacles.
  for (const Tree* tree : {&cloth_edges_, &obstacle_edges_}) {
    if (tree->empty()) continue;
    run("broad_phase.edge_edge", mesh.cloth_edges,
        EdgeEdgeQuery{tree->view(),
                      {cloth_edges_.leaves().view(), boxes.edge},
                      mesh.edge.view(),
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

  // Dirty vertices are compared with all faces. They lie apart, so that each queries for itself.
  for (const Tree* tree : {&cloth_faces_, &obstacle_faces_}) {
    if (tree->empty()) continue;
    run("broad_phase.dirty_vertex_face", dirty_vertices_.size(),
        VertexFaceQuery<OneElement>{
            tree->view(), {dirty_vertices_.view(), boxes.vertex}, mesh.face.view(), {}},
        out.vertex_faces, out);
  }

  // The clean vertices meet the dirty faces only, in a tree of their own.
  dirty_face_tree_.build(boxes.face, dirty_faces_.view());
  if (!dirty_face_tree_.empty())
    for (const CurveOrder* vertices : {&cloth_vertices_, &obstacle_vertices_})
      run("broad_phase.dirty_vertex_face", vertices->size(),
          VertexFaceQuery<Neighbours>{dirty_face_tree_.view(),
                                      {vertices->view(), boxes.vertex},
                                      mesh.face.view(),
                                      dirty_vertex},
          out.vertex_faces, out);

  // Dirty edges are compared with all edges.
  for (const Tree* tree : {&cloth_edges_, &obstacle_edges_}) {
    if (tree->empty()) continue;
    run("broad_phase.dirty_edge_edge", dirty_edges_.size(),
        DirtyEdgeQuery{tree->view(), {dirty_edges_.view(), boxes.edge}, dirty_edge}, out.edge_edges,
        out);
  }
}

}  // namespace icloth::ICLOTH_BUILD
