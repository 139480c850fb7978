// The kernels that lead from impacts to zones: they merge constraints, spread labels, and load the
// arrays that the solvers work on.
#pragma once

#include "kernels/impact.h"
#include "kernels/zones/zone_problem.h"

namespace icloth::ICLOTH_BUILD {

/// Lists the old constraints first, then this round's impacts as new constraints.
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
      all[i] = {m.key, m.s, m.normal, m.offset, Real(0), 0, 1};
    }
  }
};

/// Keeps the last one of equal keys, which is the newest: its normal and weights replace the old
/// ones.
struct IsNewest {
  View<const KeptImpact> sorted;
  ICLOTH_HD bool operator()(Index i) const {
    return i + 1 == sorted.size() || sorted[i + 1].key != sorted[i].key;
  }
};

/// Copies the newest constraint of each key.
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

/// The vertex number of each corner that can move.
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

/// Keeps the vertices that belong to at least one constraint.
struct HasEntries {
  View<const Index> first;
  ICLOTH_HD bool operator()(Index i) const { return first[i + 1] > first[i]; }
};

/// Numbers the active vertices; the number of a vertex is its slot and its first label.
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

/// The smallest label among the corners of a constraint.
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

/// The smallest label among the constraints of a vertex, followed by a jump to that label's own
/// label. Returns 1 where the label changed. Repeated until nothing changes, this labels connected
/// components.
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

/// The keys that sort vertices by zone.
struct LabelKeys {
  View<const Index> label;
  View<std::uint64_t> keys;
  View<Index> order;
  ICLOTH_HD void operator()(Index i) const {
    keys[i] = static_cast<std::uint64_t>(label[i]);
    order[i] = i;
  }
};

/// Keeps the first position of each range of equal keys.
struct StartsRange {
  View<const std::uint64_t> keys;
  ICLOTH_HD bool operator()(Index i) const { return i == 0 || keys[i] != keys[i - 1]; }
};

/// Sets the last entry of a list.
struct SetLast {
  View<Index> list;
  Index value;
  ICLOTH_HD void operator()(Index) const { list[list.size() - 1] = value; }
};

/// Loads the vertices in the order of their zones.
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

/// Loads the constraints in the order of their zones, with corners renumbered to the new slots.
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
    constraints[i] = {kept[k].s, slot, kept[k].normal, kept[k].offset};
    zone_slots[i] = slot;
    multiplier[i] = kept[k].multiplier;
  }
};

}  // namespace icloth::ICLOTH_BUILD
