#include "sim/collision/ccd.h"

#include "kernels/ccd/elementary_ccd.h"
#include "kernels/parallel/parallel.h"
#include "sim/collision/seam_exclusion.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Tests one candidate pair and emits its impact.
struct ImpactTest {
  View<const Vec3r> x0, x1;
  View<const Real> inverse_mass;
  View<const std::uint8_t> dirty;
  bool incremental;
  double offset;  ///< δ [m]
  LetGoView let_go;
  SeamView seams;

  /// True for a pair that cannot touch anew: nothing of it can move, or no vertex of it is dirty.
  /// True also where its contacts are let go.
  ICLOTH_HD bool skip(const Index v[4]) const {
    bool movable = false, changed = false;
    for (int a = 0; a < 4; ++a) {
      movable = movable || inverse_mass[v[a]] > 0;
      changed = changed || (incremental && v[a] < dirty.size() && dirty[v[a]] != 0);
    }
    return !movable || (incremental && !changed) || let_go.ignores(v);
  }

  template <class Emit>
  ICLOTH_HD void test(bool edge_edge, Pair pair, const Index v[4], Emit& emit) const {
    if (skip(v)) return;

    // The elementary test gets the four trajectories.
    CcdQuery<Real> q;
    for (int a = 0; a < 4; ++a) q.p0[a] = x0[v[a]], q.p1[a] = x1[v[a]];
    CcdHit hit;
    const double keep = seams.offset(edge_edge, v, offset);
    const double separation = 0.25 * keep;  // of the degenerate fallback
    if (!(edge_edge ? ccd_ee(q, separation, hit) : ccd_vf(q, separation, hit))) return;

    // The impact keeps the weights and the normal at the time of the contact.
    Impact impact;
    impact.key = pair_key(edge_edge, pair);
    for (int a = 0; a < 4; ++a) {
      impact.s.v[a] = v[a];
      impact.s.w[a] = static_cast<Real>(hit.w[a]);
    }
    impact.normal = convert<Real>(hit.normal);
    impact.offset = static_cast<Real>(keep);
    impact.toi = static_cast<Real>(hit.toi);
    emit(impact);
  }
};

/// Tests a vertex against a face.
struct TestVertexFace {
  ImpactTest base;
  View<const Pair> candidates;
  View<const Int3> face;

  /// Returns 1 for a pair that is tested, to count them.
  ICLOTH_HD Index operator()(Index i) const {
    const Int3 f = face[candidates[i].b];
    const Index v[4] = {candidates[i].a, f.v[0], f.v[1], f.v[2]};
    return base.skip(v) ? 0 : 1;
  }

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Pair pair = candidates[i];
    const Int3 f = face[pair.b];
    const Index v[4] = {pair.a, f.v[0], f.v[1], f.v[2]};
    base.test(false, pair, v, emit);
  }
};

/// Tests an edge against an edge.
struct TestEdgeEdge {
  ImpactTest base;
  View<const Pair> candidates;
  View<const Int2> edge;

  ICLOTH_HD Index operator()(Index i) const {
    const Int2 p = edge[candidates[i].a], q = edge[candidates[i].b];
    const Index v[4] = {p.v[0], p.v[1], q.v[0], q.v[1]};
    return base.skip(v) ? 0 : 1;
  }

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Pair pair = candidates[i];
    const Int2 p = edge[pair.a], q = edge[pair.b];
    const Index v[4] = {p.v[0], p.v[1], q.v[0], q.v[1]};
    base.test(true, pair, v, emit);
  }
};

}  // namespace

void Ccd::find(SubstepContext& step, const BroadPhase& broad_phase, View<const std::uint8_t> dirty,
               bool incremental, const LetGoView& let_go) {
  const Topology& mesh = step.mesh;
  const State& s = step.state;
  const ImpactTest base{.x0 = s.x0.view(),
                        .x1 = s.x1.view(),
                        .inverse_mass = s.inverse_mass.view(),
                        .dirty = dirty,
                        .incremental = incremental,
                        .offset = static_cast<double>(step.offset()),
                        .let_go = let_go,
                        .seams = seam_view(mesh)};
  impacts_.resize(0);

  // The lists are sorted by key, vertices against faces first, so that they depend on the state
  // alone.
  const Array<Pair>& vf = broad_phase.vertex_faces();
  const Array<Pair>& ee = broad_phase.edge_edges();
  const TestVertexFace test_vf{base, vf.view(), mesh.face.view()};
  const TestEdgeEdge test_ee{base, ee.view(), mesh.edge.view()};
  collect("ccd.vertex_face", vf.size(), test_vf, found_);
  append_sorted_("ccd.sort", found_, impacts_);
  collect("ccd.edge_edge", ee.size(), test_ee, found_);
  append_sorted_("ccd.sort", found_, impacts_);

  // A round that tests dirty pairs alone has to count them.
  step.report.elementary_tests +=
      incremental ? std::int64_t{reduce("ccd.count", vf.size(), Index{0}, test_vf, Sum{})} +
                        reduce("ccd.count", ee.size(), Index{0}, test_ee, Sum{})
                  : broad_phase.candidate_count();
}

}  // namespace icloth::ICLOTH_BUILD
