#include "sim/broad_phase.h"

#include <algorithm>

#include "kernels/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct UniteBoxes {
  ICLOTH_HD Box operator()(Box a, const Box& b) const {
    include(a, b);
    return a;
  }
};

/// Where the vertices go in this step: to x1, or as velocity and gravity let expect.
struct Paths {
  View<const Vec3r> from, to;  ///< to: end positions, or velocities when predicting
  bool predicted;
  Real dt;
  Vec3r fall;  ///< displacement by gravity in this step [m]
  Index cloth_vertices;

  ICLOTH_HD Box swept(Index i, Real pad) const {
    Vec3r end = to[i];
    if (predicted) {
      end = from[i] + dt * to[i];
      if (i < cloth_vertices) end += fall;
    }
    return swept_box(from[i], end, pad);
  }
};

Paths make_paths(const StepContext& step, bool predicted) {
  const Array<Vec3r>& to = predicted ? step.state.v : step.state.x1;
  return {
      step.state.x0.view(),    to.view(), predicted, step.dt, (step.dt * step.dt) * step.gravity(),
      step.mesh.cloth_vertices};
}

/// Trusted region of a vertex.
struct VertexBoxes {
  Paths paths;
  View<Box> box;
  Real pad;

  ICLOTH_HD void operator()(Index i) const { box[i] = paths.swept(i, pad); }
};

struct FaceBoxes {
  View<const Int3> face;
  View<const Box> vertex;
  View<Box> box;

  ICLOTH_HD void operator()(Index f) const {
    Box b = vertex[face[f].v[0]];
    include(b, vertex[face[f].v[1]]);
    include(b, vertex[face[f].v[2]]);
    box[f] = b;
  }
};

struct EdgeBoxes {
  View<const Int2> edge;
  View<const Box> vertex;
  View<Box> box;

  ICLOTH_HD void operator()(Index e) const {
    Box b = vertex[edge[e].v[0]];
    include(b, vertex[edge[e].v[1]]);
    box[e] = b;
  }
};

/// 1 where a vertex leaves its trusted region, with `margin` around its path.
struct Outside {
  Paths paths;
  View<const Box> box;
  Real margin;

  ICLOTH_HD Index operator()(Index i) const {
    const Box path = paths.swept(i, margin);
    bool contained = true;
    for (int k = 0; k < 3; ++k)
      contained = contained && path.lo[k] >= box[i].lo[k] && path.hi[k] <= box[i].hi[k];
    return contained ? 0 : 1;
  }
};

struct CopyPairs {
  View<const Pair> from;
  View<Pair> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[i]; }
};

struct BoxAt {
  View<const Box> box;
  Index first;
  ICLOTH_HD Box operator()(Index i) const { return box[first + i]; }
};

struct MortonCodes {
  View<const Box> box;
  View<std::uint64_t> code;
  View<Index> item;
  Box bounds;
  Index first;

  ICLOTH_HD void operator()(Index i) const {
    const Box& b = box[first + i];
    float p[3];
    for (int k = 0; k < 3; ++k) {
      const float extent = bounds.hi[k] - bounds.lo[k];
      p[k] = extent > 0 ? (0.5f * (b.lo[k] + b.hi[k]) - bounds.lo[k]) / extent : 0.0f;
    }
    code[i] = morton_code(p[0], p[1], p[2]);
    item[i] = first + i;
  }
};

struct FitLeaves {
  View<const Box> box;
  View<const Index> item;
  View<TreeNode> node;

  ICLOTH_HD void operator()(Index n) const {
    for (int c = 0; c < kTreeWidth; ++c) {
      const Index leaf = n * kTreeWidth + c;
      set_child(node[n], c, leaf < item.size() ? box[item[leaf]] : Box{});
    }
  }
};

struct FitLevel {
  View<TreeNode> node;
  Index below, below_count, level;

  ICLOTH_HD void operator()(Index n) const {
    for (int c = 0; c < kTreeWidth; ++c) {
      const Index child = n * kTreeWidth + c;
      Box b;
      if (child < below_count)
        for (int k = 0; k < kTreeWidth; ++k) include(b, child_box(node[below + child], k));
      set_child(node[level + n], c, b);
    }
  }
};

/// (vertex, face) candidates of one vertex against one tree.
struct VertexFaceQuery {
  TreeView tree;
  View<const Box> box;
  View<const Int3> face;
  Index first;

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Index v = first + i;
    query_tree(tree, box[v], kNone, [&](Index, Index f) {
      const Int3& t = face[f];
      if (t.v[0] != v && t.v[1] != v && t.v[2] != v) emit(Pair{v, f});
    });
  }
};

/// (edge, edge) candidates of one cloth edge against one tree. In its own tree an edge meets only
/// the leaves after its own, so that each pair is found once.
struct EdgeEdgeQuery {
  TreeView tree;
  View<const Index> order;  ///< query edges in leaf order
  View<const Box> box;
  View<const Int2> edge;
  bool own_tree;

  template <class Emit>
  ICLOTH_HD void operator()(Index leaf, Emit& emit) const {
    const Index e = order[leaf];
    const Int2 p = edge[e];
    query_tree(tree, box[e], own_tree ? leaf : kNone, [&](Index, Index other) {
      const Int2& q = edge[other];
      if (p.v[0] == q.v[0] || p.v[0] == q.v[1] || p.v[1] == q.v[0] || p.v[1] == q.v[1]) return;
      emit(e < other ? Pair{e, other} : Pair{other, e});
    });
  }
};

}  // namespace

TreeView Tree::view() const {
  TreeView t;
  t.nodes = nodes_.view();
  t.items = items_.view();
  t.levels = levels_;
  for (int l = 0; l < levels_; ++l) t.level_first[l] = level_first_[l];
  return t;
}

void Tree::build(View<const Box> boxes, Index first) {
  const Index n = boxes.size() - first;
  items_.resize(n);
  levels_ = 0;
  if (n == 0) return;
  codes_.resize(n);
  const Box bounds = reduce("broad_phase.bounds", n, Box{}, BoxAt{boxes, first}, UniteBoxes{});
  for_each("broad_phase.morton", n,
           MortonCodes{boxes, codes_.view(), items_.view(), bounds, first});
  sort_by_key("broad_phase.sort", codes_.view(), items_.view(), 30);
  Index total = 0;
  for (Index count = n; levels_ == 0 || count > 1;) {
    count = (count + kTreeWidth - 1) / kTreeWidth;
    level_first_[levels_] = total;
    level_count_[levels_++] = count;
    total += count;
  }
  nodes_.resize(total);
  refit(boxes);
}

void Tree::refit(View<const Box> boxes) {
  if (levels_ == 0) return;
  for_each("broad_phase.leaves", level_count_[0], FitLeaves{boxes, items_.view(), nodes_.view()});
  for (int l = 1; l < levels_; ++l)
    for_each("broad_phase.refit", level_count_[l],
             FitLevel{nodes_.view(), level_first_[l - 1], level_count_[l - 1], level_first_[l]});
}

void BroadPhase::make_boxes(StepContext& step, bool predicted, bool after_impacts) {
  const Topology& mesh = step.mesh;
  // Pad: the repulsion reaches h, and what the solve does beyond the prediction must fit too.
  const Real pad = std::max({static_cast<Real>(0.75) * step.thickness(), 2 * step.offset(),
                             // After a zone solve, the next ones will move vertices further still.
                             static_cast<Real>(after_impacts ? 0.5 : 0.2) * mesh.median_edge});
  vertex_box_.resize(mesh.vertices);
  face_box_.resize(mesh.faces);
  edge_box_.resize(mesh.edges);
  for_each("broad_phase.vertex_boxes", mesh.vertices,
           VertexBoxes{make_paths(step, predicted), vertex_box_.view(), pad});
  for_each("broad_phase.face_boxes", mesh.faces,
           FaceBoxes{mesh.face.view(), vertex_box_.view(), face_box_.view()});
  for_each("broad_phase.edge_boxes", mesh.edges,
           EdgeBoxes{mesh.edge.view(), vertex_box_.view(), edge_box_.view()});

  const bool rebuild = !valid_ || ++refits_ >= step.parameters.rebuild_interval;
  if (rebuild) refits_ = 0;
  const auto update = [&](Tree& tree, const Array<Box>& boxes, Index first, Index last) {
    const View<const Box> upto = boxes.view().sub(0, last);
    if (rebuild)
      tree.build(upto, first);
    else
      tree.refit(upto);
  };
  update(cloth_faces_, face_box_, 0, mesh.cloth_faces);
  update(cloth_edges_, edge_box_, 0, mesh.cloth_edges);
  update(obstacle_faces_, face_box_, mesh.cloth_faces, mesh.faces);
  update(obstacle_edges_, edge_box_, mesh.cloth_edges, mesh.edges);
  valid_ = true;
}

void BroadPhase::find_candidates(const StepContext& step) {
  const Topology& mesh = step.mesh;
  const View<const Box> vertex = vertex_box_.view(), edge = edge_box_.view();
  vertex_faces_.resize(0);
  edge_edges_.resize(0);
  const auto append = [&](Array<Pair>& list) {
    const Index old = list.size();
    list.resize_keep(old + found_.size());
    for_each("broad_phase.append", found_.size(),
             CopyPairs{found_.view(), list.view().sub(old, found_.size())});
  };
  const auto vertices_against = [&](const Tree& tree, Index first, Index count) {
    if (tree.empty() || count == 0) return;
    collect("broad_phase.vertex_face", count,
            VertexFaceQuery{tree.view(), vertex, mesh.face.view(), first}, found_);
    append(vertex_faces_);
  };
  vertices_against(cloth_faces_, 0, mesh.cloth_vertices);
  vertices_against(obstacle_faces_, 0, mesh.cloth_vertices);
  vertices_against(cloth_faces_, mesh.cloth_vertices, mesh.vertices - mesh.cloth_vertices);
  for (const Tree* tree : {&cloth_edges_, &obstacle_edges_}) {
    if (tree->empty()) continue;
    collect("broad_phase.edge_edge", mesh.cloth_edges,
            EdgeEdgeQuery{tree->view(), cloth_edges_.view().items, edge, mesh.edge.view(),
                          tree == &cloth_edges_},
            found_);
    append(edge_edges_);
  }
}

bool BroadPhase::covers(StepContext& step, bool predicted, Real margin) const {
  return valid_ &&
         reduce("broad_phase.outside", step.mesh.vertices, Index{0},
                Outside{make_paths(step, predicted), vertex_box_.view(), margin}, Sum{}) == 0;
}

void BroadPhase::prepare(StepContext& step) {
  // Two elements closer than h must overlap: each end needs half of h around it.
  if (covers(step, true, static_cast<Real>(0.5) * step.thickness())) return;
  make_boxes(step, true, false);
  find_candidates(step);
}

void BroadPhase::cover_candidate(StepContext& step, bool after_impacts) {
  if (covers(step, false, Real(0))) return;
  make_boxes(step, false, after_impacts);
  find_candidates(step);
}

}  // namespace icloth::ICLOTH_BUILD
