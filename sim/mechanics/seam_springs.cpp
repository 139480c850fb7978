#include "sim/mechanics/seam_springs.h"

#include "kernels/parallel/parallel.h"
#include "kernels/seam_spring.h"
#include "sim/scene/seam_pairs.h"
#include "sim/state/upload.h"

namespace icloth::ICLOTH_BUILD {
namespace {

using StitchState = StitchStateOf<Real>;

constexpr Real kProgress = Real(0.99);  // share of the distance that counts as coming nearer

ICLOTH_HD Real distance_of(const StitchPair& p, View<const Vec3r> x) {
  return norm(x[p.a] - x[p.b]);
}

/// Mass with which a pair answers to a force between its vertices; 0 where both are held [kg].
ICLOTH_HD Real reduced_mass(const StitchPair& p, View<const Real> inverse_mass) {
  const Real mobility = inverse_mass[p.a] + inverse_mass[p.b];
  return mobility > 0 ? 1 / mobility : Real(0);
}

struct IsClosing {
  View<const StitchPair> pairs;
  View<const StitchState> states;
  View<const Real> inverse_mass;
  ICLOTH_HD bool operator()(Index i) const {
    return states[i].clock >= 0 && reduced_mass(pairs[i], inverse_mass) > 0;
  }
};

/// Stiffness of the spring of a pair [N/m].
ICLOTH_HD Real stiffness_of(const SeamLaw& law, const StitchState& s, Real mass, Real distance) {
  return s.closed != 0 ? holding_stiffness(law) : seam_stiffness(law, s.clock, mass, distance);
}

/// An implicit spring of length zero with critical damping.
struct MakeCoupling {
  View<const StitchPair> pairs;
  View<const StitchState> states;
  View<const Index> closing;
  View<const Vec3r> x0, free_motion, v;
  View<const Real> inverse_mass;
  SeamLaw law;
  Real h;
  View<Coupling> out;

  ICLOTH_HD void operator()(Index i) const {
    const StitchPair& p = pairs[closing[i]];
    const Real mass = reduced_mass(p, inverse_mass);
    const Vec3r gap = x0[p.a] - x0[p.b];
    const Real k = stiffness_of(law, states[closing[i]], mass, norm(gap));
    const Real damping = 2 * std::sqrt(k * mass);

    // The stencil names both vertices twice, the second time without weight.
    Coupling c;
    c.s = {{p.a, p.b, p.a, p.b}, {Real(1), Real(-1), Real(0), Real(0)}};
    const Real stiffness = h * h * k + h * damping;
    c.h = {{stiffness, 0, 0, stiffness, 0, stiffness}};
    c.impulse =
        (-h * k) * (gap + free_motion[p.a] - free_motion[p.b]) - (h * damping) * (v[p.a] - v[p.b]);
    out[i] = c;
  }
};

/// Force that a coupling applied, times the motion that it was applied over.
struct SeamWork {
  View<const Coupling> couplings;
  View<const Vec3r> free_motion, dv;
  View<const Real> inverse_mass;
  Real h;

  ICLOTH_HD double operator()(Index i) const {
    const Coupling& c = couplings[i];
    Vec3r change{}, motion{};
    for (int a = 0; a < 2; ++a) {
      const Index v = c.s.v[a];
      if (!(inverse_mass[v] > 0)) continue;
      change += c.s.w[a] * dv[v];
      motion += c.s.w[a] * (free_motion[v] + h * dv[v]);
    }
    return dot_double((1 / h) * (c.impulse - c.h * change), motion);
  }
};

struct AdvanceClock {
  View<const StitchPair> pairs;
  View<const Vec3r> x;
  Real reach, dt;
  View<StitchState> states;

  ICLOTH_HD void operator()(Index i) const {
    StitchState& s = states[i];
    if (s.clock >= 0) {
      s.clock += dt;
    } else if (distance_of(pairs[i], x) < reach) {
      s.clock = 0;
    }
  }
};

/// A pair grows older while it comes no nearer although it is pulled as strongly as it may be.
struct WatchPair {
  View<const StitchPair> pairs;
  View<const Vec3r> x;
  View<const Real> inverse_mass;
  SeamLaw law;
  View<StitchState> states;

  ICLOTH_HD void operator()(Index i) const {
    StitchState& s = states[i];
    if (!(s.clock >= 0)) return;
    const Real distance = distance_of(pairs[i], x);
    if (distance < law.closed) s.closed = 1;
    const bool nearer = s.closed != 0 || s.age == 0 || distance < kProgress * s.mark;
    if (nearer) s.mark = distance;

    // Two vertices that are both held will never meet, however they are pulled.
    const Real mass = reduced_mass(pairs[i], inverse_mass);
    const bool fully = !(mass > 0) || pulls_fully(law, s.clock, mass, distance);
    s.age = nearer ? 1 : s.age + (fully ? 1 : 0);
  }
};

/// What the statistics say about a pair, or about several together.
struct SeamSums {
  Index open, stuck;
  Real gap;
  ICLOTH_HD friend SeamSums operator+(SeamSums a, SeamSums b) {
    return {a.open + b.open, a.stuck + b.stuck, Max{}(a.gap, b.gap)};
  }
};

struct SeamSumsOf {
  View<const StitchPair> pairs;
  View<const StitchState> states;
  View<const Vec3r> x;
  Real closed;

  ICLOTH_HD SeamSums operator()(Index i) const {
    const Real distance = distance_of(pairs[i], x);
    return {distance > closed ? 1 : 0, states[i].age > kStuckSteps ? 1 : 0, distance};
  }
};

Real real(double value) { return static_cast<Real>(value); }

/// Pairs that are nearer than this are closed [m].
Real closed_distance(const Topology& mesh) {
  return real(weld_tolerance(static_cast<double>(mesh.median_edge)));
}

SeamLaw seam_law(const Topology& mesh, const Parameters& parameters) {
  const SeamParameters& p = parameters.seams;
  const Real force = real(p.max_pull) * mesh.median_edge;  // a pair has about so much of the seam
  return {real(p.slowest), real(p.fastest), real(p.ramp), force, closed_distance(mesh)};
}

}  // namespace

void upload_seams(Topology& mesh, State& state, const Scene& scene, const World& world) {
  const std::vector<StitchedPair> pairs = stitched_pairs(scene, world);
  if (pairs.empty()) return;
  upload_as(mesh.stitches, pairs, [](const StitchedPair& p) { return StitchPair{p.a, p.b}; });
  upload_as(state.stitches, pairs, [](const StitchedPair& p) {
    return StitchState{p.pulls ? Real(0) : Real(-1), Real(0), 0, 0};
  });
  const SeamNeighbours neighbours = seam_neighbours(world, pairs);
  mesh.seam_neighbour_first.upload(neighbours.first);
  mesh.seam_neighbour.upload(neighbours.vertex);
}

void SeamSprings::assemble(const SubstepContext& step, View<const Vec3r> free_motion,
                           View<const Vec3r> v, Real h) {
  couplings_.resize(0);
  const View<const StitchPair> pairs = step.mesh.stitches.view();
  if (pairs.size() == 0) return;

  // Pairs that wait for a hand, and those of two held vertices, pull nothing.
  const State& s = step.state;
  const Index count = compact("seams.closing", pairs.size(),
                              IsClosing{pairs, s.stitches.view(), s.inverse_mass.view()}, closing_);
  couplings_.resize(count);
  for_each("seams.couplings", count,
           MakeCoupling{.pairs = pairs,
                        .states = s.stitches.view(),
                        .closing = closing_.view(),
                        .x0 = s.x0.view(),
                        .free_motion = free_motion,
                        .v = v,
                        .inverse_mass = s.inverse_mass.view(),
                        .law = seam_law(step.mesh, step.parameters),
                        .h = h,
                        .out = couplings_.view()});
}

double SeamSprings::work(View<const Vec3r> free_motion, View<const Vec3r> dv,
                         View<const Real> inverse_mass, Real h) const {
  if (couplings_.empty()) return 0;
  return reduce("seams.work", couplings_.size(), 0.0,
                SeamWork{couplings_.view(), free_motion, dv, inverse_mass, h}, Sum{});
}

void advance_seams(const Topology& mesh, const Parameters& parameters, State& state, Real dt) {
  if (mesh.stitches.empty()) return;
  for_each("seams.clocks", mesh.stitches.size(),
           AdvanceClock{mesh.stitches.view(), state.x1.view(), real(parameters.seams.reach), dt,
                        state.stitches.view()});
}

void watch_seams(const Topology& mesh, const Parameters& parameters, State& state) {
  if (mesh.stitches.empty()) return;
  for_each("seams.watch", mesh.stitches.size(),
           WatchPair{mesh.stitches.view(), state.x1.view(), state.inverse_mass.view(),
                     seam_law(mesh, parameters), state.stitches.view()});
}

void report_seams(const Topology& mesh, const State& state, StateReport& report) {
  if (mesh.stitches.empty()) return;
  const SeamSums sums = reduce("seams.report", mesh.stitches.size(), SeamSums{0, 0, 0},
                               SeamSumsOf{mesh.stitches.view(), state.stitches.view(),
                                          state.x1.view(), closed_distance(mesh)},
                               Sum{});
  report.open_pairs = sums.open;
  report.stuck_pairs = sums.stuck;
  report.seam_gap = static_cast<double>(sums.gap);
}

}  // namespace icloth::ICLOTH_BUILD
