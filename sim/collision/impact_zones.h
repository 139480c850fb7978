// Stage 4: groups the impacts into zones and moves their vertices until the constraints hold
// (paper Section 4). Constraints are kept over the rounds of a step.
#pragma once

#include "kernels/zones/zone_solve.h"
#include "sim/collision/ccd.h"
#include "sim/linear/incidence.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

class ImpactZones {
 public:
  /// Forgets the constraints of the last substep.
  void begin_substep() {
    kept_.resize(0);
    corrected_ = false;
  }

  /// Adds this round's impacts, solves all zones and writes state.x1 and dirty().
  void solve(SubstepContext& step, const Array<Impact>& impacts);

  /// Sets x1 to the result of the implicit step.
  void back_to_candidate(SubstepContext& step);
  /// Sets every vertex of a colliding pair back to where it was at the start; writes dirty(). False
  /// when all of them were there already.
  bool roll_back(SubstepContext& step, const Array<Impact>& impacts);

  /// Whether x1 may differ from the result of the implicit step.
  bool corrected() const { return corrected_; }
  /// Largest |x1 − x*| of the last solve [m].
  Real largest_correction() const { return largest_correction_; }

  /// 1 for vertices that moved in the last solve or collided before it (cloth_vertices).
  View<const std::uint8_t> dirty() const { return dirty_.view(); }

 private:
  void merge(const Array<Impact>& impacts);
  void label_zones(const SubstepContext& step);
  void order_by_zone();
  void sort_by_label(const Array<Index>& label, Array<Index>& order, Array<Index>& first);
  void load_zones(const SubstepContext& step);
  ZoneArrays zone_arrays(const State& state);
  void solve_zones(const SubstepContext& step);
  template <template <class> class Solver>
  void solve_zones_with(const SolveZone<Solver>& solve);
  void store(SubstepContext& step);
  void drop_idle();
  void report(SubstepContext& step, Index dynamic_faces) const;

  Array<KeptImpact> kept_;  ///< sorted by key, merge
  Array<KeptImpact> unsorted_, sorted_;
  SortedAppend append_sorted_;
  Array<Index> picked_;
  Array<std::uint64_t> keys_;

  Incidence incidence_;              ///< constraints of a vertex, then of a slot
  Array<Int4> slots_;                ///< corners of kept_ (constraints), label_zones
  Array<Index> unsorted_active_;     ///< free vertices with a constraint, label_zones
  Array<Index> slot_of_;             ///< place there of a vertex (cloth_vertices), label_zones
  Array<Index> label_, next_label_;  ///< smallest slot of the zone (active), label_zones
  Array<Index> constraint_label_;    ///< smallest slot of the zone (constraints), label_zones

  Array<Index> vertex_order_, new_slot_;          ///< slots by zone and back, order_by_zone
  Array<Index> kept_of_;                          ///< kept_ index of each constraint by zone
  Array<Index> vertex_first_, constraint_first_;  ///< ranges (zones + 1), order_by_zone
  Array<Index> active_;                           ///< vertices by zone (active), order_by_zone
  Array<ZoneConstraint> constraints_;             ///< by zone, order_by_zone
  Array<Int4> zone_slots_;
  Array<Vec3r> target_, x_, before_, direction_;  ///< see ZoneArrays
  Array<Real> mass_, multiplier_, shortfall_, scratch1_, scratch2_;
  Array<ZoneResult> results_;
  Array<std::uint8_t> dirty_;
  Real largest_correction_ = 0;
  bool corrected_ = false;
};

}  // namespace icloth::ICLOTH_BUILD
