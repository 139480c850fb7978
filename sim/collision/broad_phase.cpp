#include "sim/collision/broad_phase.h"

#include <algorithm>
#include <utility>

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// The motion of the vertices in this step: to x1, or to where velocity and gravity are expected to
/// take them.
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

Paths make_paths(const SubstepContext& step, bool predicted) {
  const Array<Vec3r>& to = predicted ? step.state.v : step.state.x1;
  return {.from = step.state.x0.view(),
          .to = to.view(),
          .predicted = predicted,
          .dt = step.dt,
          .fall = (step.dt * step.dt) * step.gravity(),
          .cloth_vertices = step.mesh.cloth_vertices};
}

/// Makes the trusted region of a vertex, the padded box around its path.
struct VertexBoxes {
  Paths paths;
  View<Box> box;
  Real pad;

  ICLOTH_HD void operator()(Index i) const { box[i] = paths.swept(i, pad); }
};

/// The box of a face is the hull of the boxes of its vertices.
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

/// The box of an edge is the hull of the boxes of its vertices.
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

/// Returns 1 where a vertex leaves its trusted region, with `margin` around its path.
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

}  // namespace

void BroadPhase::make_boxes(SubstepContext& step, bool predicted, Real pad) {
  Array<Box>& trusted = step.state.trusted;
  trusted.resize(step.mesh.vertices);
  for_each("broad_phase.vertex_boxes", step.mesh.vertices,
           VertexBoxes{make_paths(step, predicted), trusted.view(), pad});
  update_hulls(step);
}

void BroadPhase::update_hulls(SubstepContext& step) {
  const Topology& mesh = step.mesh;

  // Boxes of faces and edges are unions of those of their vertices.
  const View<const Box> trusted = std::as_const(step.state.trusted).view();
  face_box_.resize(mesh.faces);
  edge_box_.resize(mesh.edges);
  for_each("broad_phase.face_boxes", mesh.faces,
           FaceBoxes{mesh.face.view(), trusted, face_box_.view()});
  for_each("broad_phase.edge_boxes", mesh.edges,
           EdgeBoxes{mesh.edge.view(), trusted, edge_box_.view()});

  // The trees keep the order of their leaves for a few refits, after which sorting anew pays.
  if (step.parameters.broad_phase.method == BroadPhaseMethod::tree) {
    const bool rebuild = !current_ || ++refits_ >= step.parameters.broad_phase.rebuild_interval;
    if (rebuild) refits_ = 0;
    tree_.update(mesh, boxes(step.state), rebuild);
  }
  current_ = true;
}

/// The distance by which paths may exceed the expected ones without making the lists anew: the
/// repulsion reaches h, and the solve differs from the prediction.
Real BroadPhase::slack(const SubstepContext& step) {
  return std::max({static_cast<Real>(0.75) * step.thickness(), 2 * step.offset(),
                   static_cast<Real>(0.2) * step.mesh.median_edge});
}

void BroadPhase::find_candidates(SubstepContext& step, View<const std::uint8_t> dirty) {
  const bool all = dirty.size() == 0;
  candidates_.clear();
  tree_.count_tests = step.parameters.broad_phase.count_tests;

  // Both methods can find all pairs, or those with a dirty vertex alone.
  const auto find = [&](auto& finder) {
    if (all)
      finder.find(step.mesh, boxes(step.state), candidates_);
    else
      finder.find_dirty(step.mesh, boxes(step.state), dirty, candidates_);
  };
  if (step.parameters.broad_phase.method == BroadPhaseMethod::tree)
    find(tree_);
  else
    find(hash_);

  // Only a list of all pairs can serve later rounds and steps.
  step.state.trusted_complete = all;
  if (step.parameters.broad_phase.count_tests) step.report.box_tests += candidates_.box_tests;
}

bool BroadPhase::covers(SubstepContext& step, bool predicted, Real margin) {
  const Array<Box>& trusted = step.state.trusted;
  return !trusted.empty() &&
         reduce("broad_phase.outside", step.mesh.vertices, Index{0},
                Outside{make_paths(step, predicted), trusted.view(), margin}, Sum{}) == 0;
}

void BroadPhase::prepare(SubstepContext& step) {
  // Two elements closer than h must overlap, so each end needs half of h around it.
  const bool trusted =
      step.state.trusted_complete && covers(step, true, static_cast<Real>(0.5) * step.thickness());
  if (trusted && current_) return;

  // A memory that came from elsewhere brings its boxes, from which the same lists follow again.
  if (trusted)
    update_hulls(step);
  else
    make_boxes(step, true, slack(step));
  find_candidates(step, {});
}

void BroadPhase::cover_candidate(SubstepContext& step) {
  if (current_ && step.state.trusted_complete && covers(step, false, Real(0))) return;
  make_boxes(step, false, slack(step));
  find_candidates(step, {});
}

void BroadPhase::cover_dirty(SubstepContext& step, View<const std::uint8_t> dirty) {
  const bool covered = covers(step, false, Real(0));
  if (covered && step.state.trusted_complete) return;
  // There is no slack here: lists of dirty pairs serve one round, and tight boxes keep them short.
  if (!covered) make_boxes(step, false, Real(0));
  find_candidates(step, dirty);
}

void BroadPhase::cover_again(SubstepContext& step) {
  make_boxes(step, false, slack(step));
  find_candidates(step, {});
}

}  // namespace icloth::ICLOTH_BUILD
