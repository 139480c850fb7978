// Stage 1: VF and EE pairs closer than the repulsion thickness (paper Section 2.5).
#pragma once

#include "kernels/contact.h"
#include "sim/broad_phase.h"
#include "sim/constraints.h"
#include "sim/state.h"

namespace icloth::ICLOTH_BUILD {

class Proximity {
 public:
  /// Finds the contacts of the step at x0, sorted by pair key.
  void find(StepContext& step, const BroadPhase& broad_phase);
  /// No contacts in this step.
  void clear(StepContext& step);

  const Array<Contact>& contacts() const { return contacts_; }
  const Incidence& incidence() const { return incidence_; }

 private:
  void note_start_gaps(const StepContext& step);
  void ramp_thickness(const StepContext& step);

  Array<Contact> contacts_;  ///< (contacts), find
  Array<Contact> found_;
  SortedAppend append_sorted_;
  Array<Int4> slots_;
  Incidence incidence_;
  /// Smallest gap of each vertex in the start state, at most h [m] (cloth_vertices); empty when
  /// nothing starts closer than h. note_start_gaps
  Array<Real> start_gap_;
};

}  // namespace icloth::ICLOTH_BUILD
