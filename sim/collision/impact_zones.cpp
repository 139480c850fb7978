#include "sim/collision/impact_zones.h"

#include <algorithm>

#include "kernels/parallel/parallel.h"
#include "kernels/zones/zone_groups.h"
#include "sim/scene/seam_pairs.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Writes the solved positions back and marks what has to be looked at again.
struct StoreVertices {
  View<const Index> active, first, entries, kept_of;
  View<const Vec3r> x;
  View<const KeptImpact> kept;
  View<Vec3r> x1;
  View<std::uint8_t> dirty;
  ICLOTH_HD void operator()(Index i) const {
    const Index v = active[i];
    bool changed = !(x[i] == x1[v]);
    for (Index k = first[i]; k < first[i + 1] && !changed; ++k)
      changed = kept[kept_of[entries[k] / 4]].fresh != 0;
    x1[v] = x[i];
    dirty[v] = changed ? 1 : 0;
  }
};

struct StoreConstraints {
  View<const Index> kept_of;
  View<const Real> multiplier, shortfall;
  View<KeptImpact> kept;
  ICLOTH_HD void operator()(Index i) const {
    KeptImpact& k = kept[kept_of[i]];
    k.multiplier = multiplier[i];
    k.idle = multiplier[i] > 0 || shortfall[i] > -k.offset ? 0 : k.idle + 1;
  }
};

/// Constraints that did nothing for two rounds with a gap over 2δ are dropped: kept on, they would
/// make layers stick.
struct StillNeeded {
  View<const KeptImpact> kept;
  ICLOTH_HD bool operator()(Index i) const { return kept[i].idle < 2; }
};

/// 1 for the faces of T_d: those with a dirty vertex.
struct IsDynamic {
  View<const Int3> face;
  View<const std::uint8_t> dirty;
  ICLOTH_HD Index operator()(Index f) const {
    const Int3 t = face[f];
    return dirty[t.v[0]] != 0 || dirty[t.v[1]] != 0 || dirty[t.v[2]] != 0 ? 1 : 0;
  }
};

struct ImpactCorners {
  View<const Impact> impacts;
  View<Int4> slots;
  ICLOTH_HD void operator()(Index i) const {
    for (int a = 0; a < 4; ++a) slots[i].v[a] = impacts[i].s.v[a];
  }
};

struct RollBack {
  View<const Index> first;  ///< impacts of each vertex
  View<const Vec3r> x0;
  View<Vec3r> x1;
  View<std::uint8_t> dirty;
  /// 1 where a vertex was somewhere else.
  ICLOTH_HD Index operator()(Index i) const {
    dirty[i] = first[i + 1] > first[i] ? 1 : 0;
    if (dirty[i] == 0 || x1[i] == x0[i]) return 0;
    x1[i] = x0[i];
    return 1;
  }
};

struct TakeCandidate {
  View<const Vec3r> candidate;
  View<Vec3r> x1;
  ICLOTH_HD void operator()(Index i) const { x1[i] = candidate[i]; }
};

struct IsLargeZone {
  View<const Index> first;
  ICLOTH_HD bool operator()(Index i) const { return first[i + 1] - first[i] > kLargestTeamZone; }
};

struct LargestZone {
  View<const Index> first;
  ICLOTH_HD Index operator()(Index i) const { return first[i + 1] - first[i]; }
};

struct Correction {
  View<const Vec3r> x, target;
  ICLOTH_HD Real operator()(Index i) const { return norm(x[i] - target[i]); }
};

struct ZoneResultAt {
  View<const ZoneResult> result;
  ICLOTH_HD ZoneResult operator()(Index i) const { return result[i]; }
};
struct WorseResult {
  ICLOTH_HD ZoneResult operator()(ZoneResult a, ZoneResult b) const {
    return {Max{}(a.iterations, b.iterations), Max{}(a.violation, b.violation),
            Max{}(a.complementarity, b.complementarity),
            Max{}(a.momentum_residual, b.momentum_residual)};
  }
};

}  // namespace

void ImpactZones::merge(const Array<Impact>& impacts) {
  const Index total = kept_.size() + impacts.size();
  unsorted_.resize(total);
  for_each("impact_zones.merge", total,
           Concatenate{kept_.view(), impacts.view(), unsorted_.view()});

  // A new impact replaces the kept constraint of its pair and goes on from its multiplier.
  sorted_.resize(0);
  append_sorted_("impact_zones.merge", unsorted_, sorted_);
  compact("impact_zones.merge", total, IsNewest{sorted_.view()}, picked_);
  kept_.resize(picked_.size());
  for_each("impact_zones.merge", picked_.size(),
           TakeNewest{sorted_.view(), picked_.view(), kept_.view()});
}

void ImpactZones::label_zones(const SubstepContext& step) {
  const Index n = kept_.size(), vertices = step.mesh.cloth_vertices;
  slots_.resize(n);
  for_each("impact_zones.corners", n,
           FreeCorners{kept_.view(), step.state.inverse_mass.view(), slots_.view()});
  incidence_.build(slots_.view(), vertices);

  // Vertices with a constraint are active; the corners name them by their slots from here on.
  compact("impact_zones.active", vertices, HasEntries{incidence_.first()}, unsorted_active_);
  const Index active = unsorted_active_.size();
  slot_of_.resize(vertices);
  label_.resize(active);
  next_label_.resize(active);
  constraint_label_.resize(n);
  for_each("impact_zones.slots", active,
           NumberSlots{unsorted_active_.view(), slot_of_.view(), label_.view()});
  for_each("impact_zones.slots", n, ToSlots{slot_of_.view(), slots_.view()});
  incidence_.build(slots_.view(), active);

  // Each constraint takes the smallest label of its vertices, and each vertex that of its
  // constraints, until all vertices of a zone have the label of its smallest slot.
  for (bool changed = true; changed;) {
    for_each("impact_zones.labels", n,
             ConstraintLabels{slots_.view(), label_.view(), constraint_label_.view()});
    changed = reduce("impact_zones.labels", active, Index{0},
                     VertexLabels{incidence_.first(), incidence_.entries(),
                                  constraint_label_.view(), label_.view(), next_label_.view()},
                     Sum{}) > 0;
    swap(label_, next_label_);
  }
}

void ImpactZones::order_by_zone() {
  sort_by_label(label_, vertex_order_, vertex_first_);
  sort_by_label(constraint_label_, kept_of_, constraint_first_);
}

/// Sorts vertices or constraints by the label of their zone; writes where each zone begins.
void ImpactZones::sort_by_label(const Array<Index>& label, Array<Index>& order,
                                Array<Index>& first) {
  const Index count = label.size();
  keys_.resize(count);
  order.resize(count);
  for_each("impact_zones.order", count, LabelKeys{label.view(), keys_.view(), order.view()});
  sort_by_key("impact_zones.order", keys_.view(), order.view(), 31);

  // One place more than there are zones tells where the last one ends.
  compact("impact_zones.order", count, StartsRange{keys_.view()}, first);
  first.resize_keep(first.size() + 1);
  for_each("impact_zones.order", 1, SetLast{first.view(), count});
}

/// Loads vertices and constraints in the order of their zones, so that the solver of a zone reads
/// one range of each array.
void ImpactZones::load_zones(const SubstepContext& step) {
  const Index n = kept_.size(), active = unsorted_active_.size();
  const State& s = step.state;
  for (Array<Vec3r>* a : {&target_, &x_, &before_, &direction_}) a->resize(active);
  mass_.resize(active);
  for (Array<Real>* a : {&multiplier_, &shortfall_, &scratch1_, &scratch2_}) a->resize(n);
  active_.resize(active);
  new_slot_.resize(active);
  constraints_.resize(n);
  zone_slots_.resize(n);

  // A vertex starts where the last round left it, and a constraint with its multiplier.
  for_each("impact_zones.load", active,
           LoadVertices{.order = vertex_order_.view(),
                        .old_active = unsorted_active_.view(),
                        .x1 = s.x1.view(),
                        .candidate = s.candidate.view(),
                        .vertex_mass = s.mass.view(),
                        .active = active_.view(),
                        .new_slot = new_slot_.view(),
                        .target = target_.view(),
                        .x = x_.view(),
                        .before = before_.view(),
                        .mass = mass_.view()});
  for_each("impact_zones.load", n,
           LoadConstraints{.order = kept_of_.view(),
                           .new_slot = new_slot_.view(),
                           .kept = kept_.view(),
                           .slots = slots_.view(),
                           .constraints = constraints_.view(),
                           .zone_slots = zone_slots_.view(),
                           .multiplier = multiplier_.view()});

  incidence_.build(zone_slots_.view(), active);
}

void ImpactZones::solve(SubstepContext& step, const Array<Impact>& impacts) {
  corrected_ = true;

  // The impacts of this round join the kept constraints; those connected by vertices make a zone.
  merge(impacts);
  label_zones(step);
  order_by_zone();
  load_zones(step);
  solve_zones(step);

  // The next round looks at the vertices that moved; idle constraints are dropped.
  store(step);
  drop_idle();
  report(step, reduce("impact_zones.dynamic_faces", step.mesh.cloth_faces, Index{0},
                      IsDynamic{step.mesh.face.view(), dirty_.view()}, Sum{}));
}

/// Each zone works on its own ranges of these arrays.
ZoneArrays ImpactZones::zone_arrays(const State& state) {
  return {.constraints = constraints_.view(),
          .constraint_first = constraint_first_.view(),
          .vertex_first = vertex_first_.view(),
          .incidence_first = incidence_.first(),
          .incidence = incidence_.entries(),
          .target = target_.view(),
          .mass = mass_.view(),
          .fixed = state.x1.view(),
          .start = state.x0.view(),
          .x = x_.view(),
          .before = before_.view(),
          .direction = direction_.view(),
          .multiplier = multiplier_.view(),
          .shortfall = shortfall_.view(),
          .scratch1 = scratch1_.view(),
          .scratch2 = scratch2_.view(),
          .result = results_.view()};
}

/// Solves every zone on its own.
void ImpactZones::solve_zones(const SubstepContext& step) {
  const ImpactZoneParameters& p = step.parameters.impact_zones;
  results_.resize(vertex_first_.size() - 1);
  const ZoneArrays arrays = zone_arrays(step.state);
  // Where a seam is open, some constraints keep a smaller offset.
  const bool open = !step.mesh.stitches.empty();
  const Real least = open ? std::min(step.offset(), static_cast<Real>(kSeamOffset)) : step.offset();
  const ZoneSettings settings{.offset = step.offset(),
                              .tolerance = Real(0.2) * least,
                              .iterations = p.iterations,
                              .penalty = static_cast<Real>(p.penalty),
                              .rho = static_cast<Real>(p.rho),
                              .step_threshold = static_cast<Real>(p.step_threshold),
                              .chebyshev = p.chebyshev};

  switch (p.solver) {
    case ZoneSolver::augmented_lagrangian:
      solve_zones_with(SolveZone<ZoneAugmentedLagrangian>{arrays, settings});
      break;
    case ZoneSolver::dual:
      solve_zones_with(SolveZone<ZoneDual>{arrays, settings});
      break;
    case ZoneSolver::linear:
      solve_zones_with(SolveZone<ZoneLinear>{arrays, settings});
      break;
  }
}

template <template <class> class Solver>
void ImpactZones::solve_zones_with(const SolveZone<Solver>& solve) {
  const Index zones = vertex_first_.size() - 1;
  for_each_team("impact_zones.solve", zones, solve);
  if (active_.size() <= kLargestTeamZone) return;
  compact("impact_zones.large", zones, IsLargeZone{vertex_first_.view()}, picked_);
  const Index size = active_.size() + constraints_.size();
  for (const Index zone : picked_.download())
    with_device_team("impact_zones.solve_large", size, SolveLargeZone<Solver>{solve, zone});
}

void ImpactZones::store(SubstepContext& step) {
  State& s = step.state;

  // The substep is refused when the largest correction is too large.
  largest_correction_ = reduce("impact_zones.correction", active_.size(), Real(0),
                               Correction{x_.view(), target_.view()}, Max{});

  // Vertices that moved are dirty: the next round tests their pairs again.
  dirty_.resize(step.mesh.cloth_vertices);
  dirty_.fill(0);
  for_each("impact_zones.store", active_.size(),
           StoreVertices{.active = active_.view(),
                         .first = incidence_.first(),
                         .entries = incidence_.entries(),
                         .kept_of = kept_of_.view(),
                         .x = x_.view(),
                         .kept = kept_.view(),
                         .x1 = s.x1.view(),
                         .dirty = dirty_.view()});

  // Multipliers are kept for the next round, which starts from them.
  for_each("impact_zones.store", constraints_.size(),
           StoreConstraints{kept_of_.view(), multiplier_.view(), shortfall_.view(), kept_.view()});
}

void ImpactZones::drop_idle() {
  compact("impact_zones.prune", kept_.size(), StillNeeded{kept_.view()}, picked_);
  unsorted_.resize(picked_.size());
  for_each("impact_zones.prune", picked_.size(),
           Permute<KeptImpact>{kept_.view(), picked_.view(), unsorted_.view()});
  swap(kept_, unsorted_);
}

void ImpactZones::report(SubstepContext& step, Index dynamic_faces) const {
  StepReport& report = step.report;
  const Index zones = results_.size();

  // The report keeps the worst numbers of all rounds and substeps of a step.
  report.dynamic_faces = dynamic_faces;
  report.zones = std::max<std::int64_t>(report.zones, zones);
  report.largest_zone = std::max<std::int64_t>(
      report.largest_zone,
      reduce("impact_zones.largest", zones, Index{0}, LargestZone{vertex_first_.view()}, Max{}));

  const ZoneResult worst = reduce("impact_zones.residuals", zones, ZoneResult{0, 0, 0, 0},
                                  ZoneResultAt{results_.view()}, WorseResult{});
  const auto larger = [](double& value, Real other) {
    value = std::max(value, static_cast<double>(other));
  };
  report.zone_iterations += worst.iterations;
  if (worst.iterations >= step.parameters.impact_zones.iterations)
    report.reach(Limit::zone_iterations);
  larger(report.zone_violation, worst.violation);
  larger(report.zone_complementarity, worst.complementarity);
  larger(report.zone_momentum_residual, worst.momentum_residual);
}

void ImpactZones::back_to_candidate(SubstepContext& step) {
  for_each("impact_zones.candidate", step.mesh.cloth_vertices,
           TakeCandidate{step.state.candidate.view(), step.state.x1.view()});
  corrected_ = false;
}

bool ImpactZones::roll_back(SubstepContext& step, const Array<Impact>& impacts) {
  const Index vertices = step.mesh.cloth_vertices;
  corrected_ = true;

  // A vertex goes back when any of its pairs collides.
  slots_.resize(impacts.size());
  for_each("impact_zones.corners", impacts.size(), ImpactCorners{impacts.view(), slots_.view()});
  incidence_.build(slots_.view(), vertices);
  dirty_.resize(vertices);
  return reduce("impact_zones.roll_back", vertices, Index{0},
                RollBack{incidence_.first(), step.state.x0.view(), step.state.x1.view(),
                         dirty_.view()},
                Sum{}) > 0;
}

}  // namespace icloth::ICLOTH_BUILD
