// Open seams: the springs that close them (kernels/seam_spring.h), and how far they have come.
//
// The springs go to the solver's list of couplings, as contacts do: the pattern of the matrix knows
// nothing of seams.
#pragma once

#include "sim/linear/couplings.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// Uploads the stitched pairs and the neighbours across seams, and sets the pairs of `state` to
/// their start. A scene without seams leaves all lists empty.
void upload_seams(Topology& mesh, State& state, const Scene& scene, const World& world);

class SeamSprings {
 public:
  /// Makes the couplings of the pairs that are closing. `free_motion` and `v`: motion and velocity
  /// with Δv = 0; `h`: from a change of velocity to one of position [s].
  void assemble(const SubstepContext& step, View<const Vec3r> free_motion, View<const Vec3r> v,
                Real h);

  View<const Coupling> couplings() const { return couplings_.view(); }

  /// Work of the springs and of their damping on the cloth, as solved [J].
  double work(View<const Vec3r> free_motion, View<const Vec3r> dv, View<const Real> inverse_mass,
              Real h) const;

 private:
  Array<Index> closing_;       ///< pairs that pull, assemble
  Array<Coupling> couplings_;  ///< one for each of them, assemble
};

/// Lets the clocks of closing pairs run on after an accepted substep, and starts those that a hand
/// has brought near.
void advance_seams(const Topology& mesh, const Parameters& parameters, State& state, Real dt);

/// Notes after an accepted step which pairs come nearer to each other.
void watch_seams(const Topology& mesh, const Parameters& parameters, State& state);

/// Writes what the statistics say about seams.
void report_seams(const Topology& mesh, const State& state, StateReport& report);

}  // namespace icloth::ICLOTH_BUILD
