#include "sim/impact_zones.h"

#include <algorithm>

#include "kernels/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Old constraints first, then this round's impacts as new constraints.
struct Concatenate {
  View<const KeptImpact> old;
  View<const Impact> impacts;
  View<KeptImpact> all;

  ICLOTH_HD void operator()(Index i) const {
    if (i < old.size()) {
      all[i] = old[i];
      all[i].fresh = 0;
    } else {
      const Impact& m = impacts[i - old.size()];
      all[i] = {m.key, m.s, m.normal, Real(0), 0, 1};
    }
  }
};

/// The last of equal keys is the newest: its normal and weights replace the old ones.
struct IsNewest {
  View<const KeptImpact> sorted;
  ICLOTH_HD bool operator()(Index i) const {
    return i + 1 == sorted.size() || sorted[i + 1].key != sorted[i].key;
  }
};

struct TakeNewest {
  View<const KeptImpact> sorted;
  View<const Index> picked;
  View<KeptImpact> kept;
  ICLOTH_HD void operator()(Index i) const {
    const Index k = picked[i];
    kept[i] = sorted[k];
    // A constraint that comes back starts from its old multiplier.
    if (k > 0 && sorted[k - 1].key == sorted[k].key) kept[i].multiplier = sorted[k - 1].multiplier;
  }
};

/// Vertex number of each corner that can move.
struct FreeCorners {
  View<const KeptImpact> kept;
  View<const Real> inverse_mass;
  View<Int4> slots;
  ICLOTH_HD void operator()(Index i) const {
    for (int a = 0; a < 4; ++a) {
      const Index v = kept[i].s.v[a];
      slots[i].v[a] = inverse_mass[v] > 0 ? v : kNone;
    }
  }
};

struct HasEntries {
  View<const Index> first;
  ICLOTH_HD bool operator()(Index i) const { return first[i + 1] > first[i]; }
};

struct NumberSlots {
  View<const Index> active;
  View<Index> slot_of, label;
  ICLOTH_HD void operator()(Index i) const {
    slot_of[active[i]] = i;
    label[i] = i;
  }
};

/// Replaces vertex numbers by slots.
struct ToSlots {
  View<const Index> slot_of;
  View<Int4> slots;
  ICLOTH_HD void operator()(Index i) const {
    for (Index& v : slots[i].v)
      if (v != kNone) v = slot_of[v];
  }
};

/// Smallest label among the corners of a constraint.
struct ConstraintLabels {
  View<const Int4> slots;
  View<const Index> label;
  View<Index> constraint_label;
  ICLOTH_HD void operator()(Index i) const {
    Index smallest = label.size();
    for (const Index s : slots[i].v)
      if (s != kNone && label[s] < smallest) smallest = label[s];
    constraint_label[i] = smallest;
  }
};

/// Smallest label among the constraints of a vertex, then a jump to that label's own label.
struct VertexLabels {
  View<const Index> first, entries, constraint_label, label;
  View<Index> next;
  ICLOTH_HD Index operator()(Index i) const {
    Index smallest = label[i];
    for (Index k = first[i]; k < first[i + 1]; ++k) {
      const Index c = constraint_label[entries[k] / 4];
      if (c < smallest) smallest = c;
    }
    if (label[smallest] < smallest) smallest = label[smallest];
    next[i] = smallest;
    return smallest != label[i] ? 1 : 0;
  }
};

struct LabelKeys {
  View<const Index> label;
  View<std::uint64_t> keys;
  View<Index> order;
  ICLOTH_HD void operator()(Index i) const {
    keys[i] = static_cast<std::uint64_t>(label[i]);
    order[i] = i;
  }
};

struct StartsRange {
  View<const std::uint64_t> keys;
  ICLOTH_HD bool operator()(Index i) const { return i == 0 || keys[i] != keys[i - 1]; }
};

struct SetLast {
  View<Index> list;
  Index value;
  ICLOTH_HD void operator()(Index) const { list[list.size() - 1] = value; }
};

/// Loads the vertices in zone order.
struct LoadVertices {
  View<const Index> order, old_active;
  View<const Vec3r> x1, candidate;
  View<const Real> vertex_mass;
  View<Index> active, new_slot;
  View<Vec3r> target, x, before;
  View<Real> mass;
  ICLOTH_HD void operator()(Index i) const {
    const Index v = old_active[order[i]];
    active[i] = v;
    new_slot[order[i]] = i;
    target[i] = candidate[v];
    x[i] = before[i] = x1[v];
    mass[i] = vertex_mass[v];
  }
};

struct LoadConstraints {
  View<const Index> order, new_slot;
  View<const KeptImpact> kept;
  View<const Int4> slots;
  View<ZoneConstraint> constraints;
  View<Int4> zone_slots;
  View<Real> multiplier;
  ICLOTH_HD void operator()(Index i) const {
    const Index k = order[i];
    Int4 slot = slots[k];
    for (Index& s : slot.v)
      if (s != kNone) s = new_slot[s];
    constraints[i] = {kept[k].s, slot, kept[k].normal};
    zone_slots[i] = slot;
    multiplier[i] = kept[k].multiplier;
  }
};

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
  Real offset;
  View<KeptImpact> kept;
  ICLOTH_HD void operator()(Index i) const {
    KeptImpact& k = kept[kept_of[i]];
    k.multiplier = multiplier[i];
    k.idle = multiplier[i] > 0 || shortfall[i] > -offset ? 0 : k.idle + 1;
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
  ICLOTH_HD void operator()(Index i) const {
    dirty[i] = first[i + 1] > first[i] ? 1 : 0;
    if (dirty[i] != 0) x1[i] = x0[i];
  }
};

struct TakeCandidate {
  View<const Vec3r> candidate;
  View<Vec3r> x1;
  ICLOTH_HD void operator()(Index i) const { x1[i] = candidate[i]; }
};

struct LargestZone {
  View<const Index> first;
  ICLOTH_HD Index operator()(Index i) const { return first[i + 1] - first[i]; }
};

struct Correction {
  View<const Vec3r> x, target;
  ICLOTH_HD Real operator()(Index i) const { return norm(x[i] - target[i]); }
};

struct ZoneIterations {
  View<const ZoneResult> result;
  ICLOTH_HD Index operator()(Index i) const { return result[i].iterations; }
};

}  // namespace

void ImpactZones::merge(const Array<Impact>& impacts) {
  const Index total = kept_.size() + impacts.size();
  unsorted_.resize(total);
  for_each("impact_zones.merge", total,
           Concatenate{kept_.view(), impacts.view(), unsorted_.view()});
  sorted_.resize(0);
  append_sorted_("impact_zones.merge", unsorted_, sorted_);
  compact("impact_zones.merge", total, IsNewest{sorted_.view()}, picked_);
  kept_.resize(picked_.size());
  for_each("impact_zones.merge", picked_.size(),
           TakeNewest{sorted_.view(), picked_.view(), kept_.view()});
}

void ImpactZones::label_zones(const StepContext& step) {
  const Index n = kept_.size(), vertices = step.mesh.cloth_vertices;
  slots_.resize(n);
  for_each("impact_zones.corners", n,
           FreeCorners{kept_.view(), step.state.inverse_mass.view(), slots_.view()});
  incidence_.build(slots_.view(), vertices);
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

void ImpactZones::order_by_zone(const StepContext& step) {
  const Index n = kept_.size(), active = unsorted_active_.size();
  const State& s = step.state;
  const auto sort_by_label = [&](const Array<Index>& label, Array<Index>& order,
                                 Array<Index>& first) {
    const Index count = label.size();
    keys_.resize(count);
    order.resize(count);
    for_each("impact_zones.order", count, LabelKeys{label.view(), keys_.view(), order.view()});
    sort_by_key("impact_zones.order", keys_.view(), order.view(), 31);
    compact("impact_zones.order", count, StartsRange{keys_.view()}, first);
    first.resize_keep(first.size() + 1);
    for_each("impact_zones.order", 1, SetLast{first.view(), count});
  };
  sort_by_label(label_, vertex_order_, vertex_first_);
  sort_by_label(constraint_label_, kept_of_, constraint_first_);

  for (Array<Vec3r>* a : {&target_, &x_, &before_, &direction_}) a->resize(active);
  mass_.resize(active);
  for (Array<Real>* a : {&multiplier_, &shortfall_, &trial_}) a->resize(n);
  active_.resize(active);
  new_slot_.resize(active);
  constraints_.resize(n);
  zone_slots_.resize(n);
  for_each("impact_zones.load", active,
           LoadVertices{vertex_order_.view(), unsorted_active_.view(), s.x1.view(),
                        s.candidate.view(), s.mass.view(), active_.view(), new_slot_.view(),
                        target_.view(), x_.view(), before_.view(), mass_.view()});
  for_each("impact_zones.load", n,
           LoadConstraints{kept_of_.view(), new_slot_.view(), kept_.view(), slots_.view(),
                           constraints_.view(), zone_slots_.view(), multiplier_.view()});
  incidence_.build(zone_slots_.view(), active);
}

void ImpactZones::solve(StepContext& step, const Array<Impact>& impacts) {
  State& s = step.state;
  const Parameters& p = step.parameters;
  merge(impacts);
  label_zones(step);
  order_by_zone(step);
  const Index zones = vertex_first_.size() - 1;
  results_.resize(zones);
  const ZoneSettings settings{step.offset(),
                              static_cast<Real>(p.penalty),
                              static_cast<Real>(p.rho),
                              static_cast<Real>(p.step_threshold),
                              p.zone_iterations,
                              p.chebyshev};
  const ZoneArrays arrays{constraints_.view(),
                          constraint_first_.view(),
                          vertex_first_.view(),
                          incidence_.first(),
                          incidence_.entries(),
                          target_.view(),
                          mass_.view(),
                          s.x1.view(),
                          x_.view(),
                          before_.view(),
                          direction_.view(),
                          multiplier_.view(),
                          shortfall_.view(),
                          trial_.view(),
                          results_.view()};
  const SolveZone solve{arrays, settings};
  for_each_team("impact_zones.solve", zones, solve);
  if (active_.size() > kLargestTeamZone) solve_large_zones(solve);

  largest_correction_ = reduce("impact_zones.correction", active_.size(), Real(0),
                               Correction{x_.view(), target_.view()}, Max{});
  dirty_.resize(step.mesh.cloth_vertices);
  dirty_.fill(0);
  for_each("impact_zones.store", active_.size(),
           StoreVertices{active_.view(), incidence_.first(), incidence_.entries(), kept_of_.view(),
                         x_.view(), kept_.view(), s.x1.view(), dirty_.view()});
  for_each("impact_zones.store", constraints_.size(),
           StoreConstraints{kept_of_.view(), multiplier_.view(), shortfall_.view(), step.offset(),
                            kept_.view()});
  compact("impact_zones.prune", kept_.size(), StillNeeded{kept_.view()}, picked_);
  unsorted_.resize(picked_.size());
  for_each("impact_zones.prune", picked_.size(),
           Permute<KeptImpact>{kept_.view(), picked_.view(), unsorted_.view()});
  swap(kept_, unsorted_);

  StepReport& report = step.report;
  report.dynamic_faces = reduce("impact_zones.dynamic_faces", step.mesh.cloth_faces, Index{0},
                                IsDynamic{step.mesh.face.view(), dirty_.view()}, Sum{});
  report.zones = std::max<std::int64_t>(report.zones, zones);
  report.largest_zone = std::max<std::int64_t>(
      report.largest_zone,
      reduce("impact_zones.largest", zones, Index{0}, LargestZone{vertex_first_.view()}, Max{}));
  report.zone_iterations +=
      reduce("impact_zones.iterations", zones, Index{0}, ZoneIterations{results_.view()}, Max{});
}

void ImpactZones::solve_large_zones(const SolveZone& solve) {
  compact("impact_zones.large", vertex_first_.size() - 1, IsLargeZone{solve}, picked_);
  const Index size = active_.size() + constraints_.size();
  for (const Index zone : picked_.download())
    with_device_team("impact_zones.solve_large", size, SolveLargeZone{solve, zone});
}

void ImpactZones::back_to_candidate(StepContext& step) {
  for_each("impact_zones.candidate", step.mesh.cloth_vertices,
           TakeCandidate{step.state.candidate.view(), step.state.x1.view()});
}

void ImpactZones::roll_back(StepContext& step, const Array<Impact>& impacts) {
  const Index vertices = step.mesh.cloth_vertices;
  slots_.resize(impacts.size());
  for_each("impact_zones.corners", impacts.size(), ImpactCorners{impacts.view(), slots_.view()});
  incidence_.build(slots_.view(), vertices);
  dirty_.resize(vertices);
  for_each("impact_zones.roll_back", vertices,
           RollBack{incidence_.first(), step.state.x0.view(), step.state.x1.view(), dirty_.view()});
}

}  // namespace icloth::ICLOTH_BUILD
