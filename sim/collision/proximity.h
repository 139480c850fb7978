// Stage 1: VF and EE pairs closer than the repulsion thickness (paper Section 2.5).
#pragma once

#include "kernels/contact.h"
#include "sim/collision/broad_phase.h"
#include "sim/linear/incidence.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// Tangential force that a pair held at the end of a substep, with which it goes on.
struct HeldForce {
  std::uint64_t key;  ///< of the pair
  Vec3r force;        ///< [N]
  Index stuck;        ///< 0: the pair was sliding
};

class Proximity {
 public:
  /// Finds the contacts of the step at x0, sorted by pair key.
  void find(SubstepContext& step, const BroadPhase& broad_phase);
  /// No contacts in this step.
  void clear();
  /// Keeps what the contacts hold after the accepted motion x0 → x1, for the next find.
  void keep_friction(const State& state, const Parameters& parameters, Real dt);

  /// Sorted by pair; what the friction of the next step starts from.
  const Array<HeldForce>& held() const { return held_; }
  Array<HeldForce>& held() { return held_; }

  const Array<Contact>& contacts() const { return contacts_; }

 private:
  void recall_friction();
  void note_start_gaps(const SubstepContext& step);
  void ramp_thickness(const SubstepContext& step);

  Array<Contact> contacts_;  ///< (contacts), find
  Array<Contact> found_;
  SortedAppend append_sorted_;
  Array<HeldForce> held_;  ///< of pairs with friction, keep_friction
  bool rubs_ = false;      ///< some contacts may have friction, find
  /// Smallest gap of each vertex in the start state, at most h [m] (cloth_vertices); empty when
  /// nothing starts closer than h. note_start_gaps
  Array<Real> start_gap_;
};

}  // namespace icloth::ICLOTH_BUILD
