#include "sim/collision/broad_phase.h"

#include <algorithm>
#include <utility>

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

constexpr Index kFewLeavers = 8;  ///< at most this part of the cloth vertices

/// The motion of the vertices in this step: to x1, or to where velocity and gravity are expected to
/// take them.
struct Paths {
  View<const Vec3r> from, to;  ///< to: end positions, or velocities when predicting
  bool predicted;
  Real dt;
  Vec3r fall;  ///< displacement by gravity in this step [m]
  Index cloth_vertices;

  ICLOTH_HD Vec3r end(Index i) const {
    if (!predicted) return to[i];
    const Vec3r moved = from[i] + dt * to[i];
    return i < cloth_vertices ? moved + fall : moved;
  }
  ICLOTH_HD Box start_box(Index i, Real pad) const { return swept_box(from[i], from[i], pad); }
  ICLOTH_HD Box end_box(Index i, Real pad) const { return swept_box(end(i), end(i), pad); }
};

ICLOTH_HD bool contains(const Box& outer, const Box& inner) {
  bool inside = true;
  for (int k = 0; k < 3; ++k)
    inside = inside && inner.lo[k] >= outer.lo[k] && inner.hi[k] <= outer.hi[k];
  return inside;
}

Paths make_paths(const SubstepContext& step, bool predicted) {
  const Array<Vec3r>& to = predicted ? step.state.v : step.state.x1;
  return {.from = step.state.x0.view(),
          .to = to.view(),
          .predicted = predicted,
          .dt = step.dt,
          .fall = (step.dt * step.dt) * step.gravity(),
          .cloth_vertices = step.mesh.cloth_vertices};
}

/// Makes the trusted regions of a vertex, padded boxes around both ends of its path.
struct VertexBoxes {
  Paths paths;
  View<Box> start, end;
  Real pad;

  ICLOTH_HD void operator()(Index i) const {
    start[i] = paths.start_box(i, pad);
    end[i] = paths.end_box(i, pad);
  }
};

/// The boxes of a face are the hulls of the boxes of its vertices.
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

/// The boxes of an edge are the hulls of the boxes of its vertices.
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

/// How the path of a vertex, with `margin` around it, is to its trusted regions.
struct Whereabouts {
  Paths paths;
  View<const Box> start, end;
  Real margin;

  /// Whether the path leads into the second box, from the first one (`fresh`) or in it.
  ICLOTH_HD bool stays(Index i, bool fresh) const {
    return contains(end[i], paths.end_box(i, margin)) &&
           contains(fresh ? start[i] : end[i], paths.start_box(i, margin));
  }

  /// 1 where the path is not from the first box to the second, and 2³² where it is not in the
  /// second: sums of both numbers of vertices fit into one.
  ICLOTH_HD std::int64_t operator()(Index i) const {
    constexpr std::int64_t not_fresh = 1, not_still = std::int64_t{1} << 32;
    if (!contains(end[i], paths.end_box(i, margin))) return not_fresh + not_still;
    const Box from = paths.start_box(i, margin);
    return (contains(start[i], from) ? 0 : not_fresh) + (contains(end[i], from) ? 0 : not_still);
  }
};

/// Marks the cloth vertices that left their boxes, and makes new ones for them. The boxes of the
/// others stay; where paths stay in the second boxes, those become the first ones too, so that all
/// paths lead from first boxes to second ones.
struct ReplaceBoxes {
  Whereabouts where;
  View<Box> start, end;
  View<std::uint8_t> left;
  Index cloth_vertices;
  bool fresh;  ///< the others go from the first box to the second
  Real pad;

  ICLOTH_HD void operator()(Index i) const {
    const bool stays = where.stays(i, fresh);
    if (i < cloth_vertices) left[i] = stays ? 0 : 1;
    if (stays) {
      if (!fresh) start[i] = end[i];
    } else {
      start[i] = where.paths.start_box(i, pad);
      end[i] = where.paths.end_box(i, pad);
    }
  }
};

/// Counts the bodies' vertices that left their boxes.
struct BodiesLeft {
  Whereabouts where;
  Index first;
  bool fresh;
  ICLOTH_HD Index operator()(Index k) const { return where.stays(first + k, fresh) ? 0 : 1; }
};

/// Picks the pairs of vertices that stayed in their boxes and that may still meet. They may if
/// their boxes are the same as before.
template <class Dirty>
struct StillCandidates {
  View<const Pair> pair;
  Dirty left;
  MovingBoxes first, second;
  bool same_boxes;
  ICLOTH_HD bool operator()(Index i) const {
    const Pair p = pair[i];
    if (same_boxes) return !left(p);
    return !left(p) && !stay_apart(first.at(p.a), second.at(p.b));
  }
};

}  // namespace

void BroadPhase::make_boxes(SubstepContext& step, bool predicted, Real pad) {
  Array<Box>&start = step.state.trusted_start, &end = step.state.trusted_end;
  start.resize(step.mesh.vertices);
  end.resize(step.mesh.vertices);
  for_each("broad_phase.vertex_boxes", step.mesh.vertices,
           VertexBoxes{make_paths(step, predicted), start.view(), end.view(), pad});
  update_hulls(step);
}

void BroadPhase::update_hulls(SubstepContext& step) {
  const Topology& mesh = step.mesh;

  // Boxes of faces and edges are unions of those of their vertices, at each end of the paths.
  const auto unite = [&](const Array<Box>& vertex, Array<Box>& face, Array<Box>& edge) {
    face.resize(mesh.faces);
    edge.resize(mesh.edges);
    for_each("broad_phase.face_boxes", mesh.faces,
             FaceBoxes{mesh.face.view(), vertex.view(), face.view()});
    for_each("broad_phase.edge_boxes", mesh.edges,
             EdgeBoxes{mesh.edge.view(), vertex.view(), edge.view()});
  };
  unite(step.state.trusted_start, face_start_, edge_start_);
  unite(step.state.trusted_end, face_end_, edge_end_);

  // The trees keep the order of their leaves for a few refits, after which sorting anew pays.
  if (step.parameters.broad_phase.method == BroadPhaseMethod::tree) {
    const bool rebuild = !current_ || ++refits_ >= step.parameters.broad_phase.rebuild_interval;
    if (rebuild) refits_ = 0;
    tree_.update(mesh, boxes(step.state), rebuild);
  }
  current_ = true;
}

/// The distance by which paths may exceed the expected ones without making the lists anew: the
/// repulsion reaches h, and the solve differs from the prediction. More of it lets the lists serve
/// the next steps too, unless something moves too far in one for that.
Real BroadPhase::slack(const SubstepContext& step) {
  const Real least = std::max(static_cast<Real>(0.75) * step.thickness(), 2 * step.offset());
  const Real lasting = static_cast<Real>(0.2) * step.mesh.median_edge;
  return static_cast<Real>(step.fastest) * step.dt > lasting ? least : std::max(least, lasting);
}

void BroadPhase::find_candidates(SubstepContext& step, View<const std::uint8_t> dirty) {
  search(step, dirty, candidates_);

  // Only a list of all pairs can serve later rounds and steps.
  step.state.trusted_complete = dirty.size() == 0;
}

void BroadPhase::search(SubstepContext& step, View<const std::uint8_t> dirty, Candidates& out) {
  out.clear();
  tree_.count_tests = step.parameters.broad_phase.count_tests;

  // Both methods can find all pairs, or those with a dirty vertex alone.
  const auto find = [&](auto& finder) {
    if (dirty.size() == 0)
      finder.find(step.mesh, boxes(step.state), out);
    else
      finder.find_dirty(step.mesh, boxes(step.state), dirty, out);
  };
  if (step.parameters.broad_phase.method == BroadPhaseMethod::tree)
    find(tree_);
  else
    find(hash_);
  if (step.parameters.broad_phase.count_tests) step.report.box_tests += out.box_tests;
}

BroadPhase::Leavers BroadPhase::leavers(SubstepContext& step, bool predicted, Real margin) {
  const Array<Box>&start = step.state.trusted_start, &end = step.state.trusted_end;
  if (start.size() != step.mesh.vertices || end.size() != step.mesh.vertices)
    return {step.mesh.vertices, step.mesh.vertices};
  const std::int64_t both =
      reduce("broad_phase.outside", step.mesh.vertices, std::int64_t{0},
             Whereabouts{make_paths(step, predicted), start.view(), end.view(), margin}, Sum{});
  return {static_cast<Index>(both & 0x7FFFFFFF), static_cast<Index>(both >> 32)};
}

bool BroadPhase::replace_leavers(SubstepContext& step, const Leavers& found) {
  State& state = step.state;
  const Topology& mesh = step.mesh;
  if (!current_ || !state.trusted_complete) return false;

  // A search for many vertices is a search for all of them.
  const bool fresh = found.fresh <= found.still;
  if ((fresh ? found.fresh : found.still) > mesh.cloth_vertices / kFewLeavers) return false;
  const Whereabouts where{make_paths(step, false), std::as_const(state.trusted_start).view(),
                          std::as_const(state.trusted_end).view(), Real(0)};

  // The paths of bodies are known in advance, so that their vertices leave when a step is cut.
  if (reduce("broad_phase.outside", mesh.vertices - mesh.cloth_vertices, Index{0},
             BodiesLeft{where, mesh.cloth_vertices, fresh}, Sum{}) > 0)
    return false;
  left_.resize(mesh.cloth_vertices);
  for_each("broad_phase.vertex_boxes", mesh.vertices,
           ReplaceBoxes{where, state.trusted_start.view(), state.trusted_end.view(), left_.view(),
                        mesh.cloth_vertices, fresh, slack(step)});
  update_hulls(step);

  // Pairs of the others stay, and the vertices that left find theirs anew.
  const ElementBoxes box = boxes(state);
  const DirtyVertices vertex{left_.view()};
  const auto keep = [&](Array<Pair>& list, const auto& picks) {
    kept_pairs_.resize(compact("broad_phase.keep", list.size(), picks, kept_));
    for_each("broad_phase.keep", kept_pairs_.size(),
             PickPairs{list.view(), kept_.view(), kept_pairs_.view()});
    swap(list, kept_pairs_);
  };
  keep(candidates_.vertex_faces,
       StillCandidates<DirtyVertexFace>{candidates_.vertex_faces.view(),
                                        {vertex, {vertex, mesh.face.view()}},
                                        box.vertex,
                                        box.face,
                                        fresh});
  keep(candidates_.edge_edges,
       StillCandidates<DirtyEdgeEdge>{
           candidates_.edge_edges.view(), {{vertex, mesh.edge.view()}}, box.edge, box.edge, fresh});
  search(step, left_.view(), more_);
  append_pairs(more_.vertex_faces, candidates_.vertex_faces);
  append_pairs(more_.edge_edges, candidates_.edge_edges);
  return true;
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
  const Leavers found = leavers(step, false, Real(0));
  if (current_ && step.state.trusted_complete && found.none()) return;
  if (replace_leavers(step, found)) return;
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
