// Stage 1: VF and EE pairs closer than the repulsion thickness (paper Section 2.5).
#pragma once

#include "kernels/contact.h"
#include "kernels/impact.h"
#include "sim/collision/broad_phase.h"
#include "sim/collision/let_go.h"
#include "sim/linear/incidence.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

class Proximity {
 public:
  /// Finds the contacts of the step at x0, sorted by pair key.
  /// Pairs that `let_go` ignores are left out.
  void find(SubstepContext& step, const BroadPhase& broad_phase, const LetGoView& let_go = {});
  /// Adds contacts without friction after those found.
  void add(const Array<Contact>& more);
  /// Adds a contact for each impact of the candidate: the pairs were too far apart at x0, or faced
  /// each other otherwise. They have the weights and the normal of the time of impact.
  void add(const SubstepContext& step, const Array<Impact>& impacts);
  /// No contacts in this step.
  void clear();
  /// Writes to state.held what the contacts hold after the accepted motion x0 → x1.
  void keep_friction(State& state, const Parameters& parameters, Real dt);

  const Array<Contact>& contacts() const { return contacts_; }

 private:
  void recall_friction(const State& state);
  void note_start_gaps(SubstepContext& step);
  void ramp_thickness(const SubstepContext& step);

  Array<Contact> contacts_;  ///< (contacts), find
  Array<Contact> found_;
  SortedAppend append_sorted_;
  Index found_at_start_ = 0;  ///< contacts in front that are sorted by key, find
  bool rubs_ = false;         ///< some contacts may have friction, find
};

}  // namespace icloth::ICLOTH_BUILD
