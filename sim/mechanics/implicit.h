// Stage 2: backward Euler (paper Section 2.4; Baraff and Witkin 1998) or BDF2, linearised at x̂: x0
// first, then where the last solve ended, while the linearisation is wrong (Newton). Later
// linearisations renew the faces that need it.
//
//   [M + h(h+d)K + contacts + springs + air] Δv = h [f(x̂) + f_ext − K (x' + h v' − x̂ + d v')]
//   x1 = x' + h (v' + Δv)      h, x', v': sim/mechanics/time_rule.h; Euler: dt, x0, v
//
// K: positive semi-definite stiffness of membrane and bending at x̂, with the measured fabric's
// coefficients frozen at x0; d: stiffness-proportional damping [s]. f and K have the yarn friction
// as well, without d (sim/mechanics/linearization.h).
//
// The forces are listed in sim/mechanics/forces.h, assembly puts them together, contact_pass
// solves.
#pragma once

#include "sim/collision/proximity.h"
#include "sim/mechanics/assembly.h"
#include "sim/mechanics/contact_pass.h"
#include "sim/mechanics/seam_springs.h"
#include "sim/mechanics/time_rule.h"

namespace icloth::ICLOTH_BUILD {

class Implicit {
 public:
  /// Lays out the matrix again where the forces couple other vertices than before.
  void match_pattern(const World& world, const Topology& mesh);

  /// Writes state.candidate and the cloth part of state.x1.
  void integrate(SubstepContext& step, const Proximity& proximity);
  /// Goes on from the candidate of this substep after contacts were added to it.
  void integrate_again(SubstepContext& step, const Proximity& proximity);

  const Forces& forces() const { return assembly_.forces(); }

  /// Writes the velocities at the end of the substep x0 → x1 and the past that the next one needs.
  void finish_substep(State& state);

  /// Largest error of the tension that the last linearisation made [N/m].
  double linearization_error() const { return linearization_error_; }
  /// Residual of the last solve, summed over all free vertices [N].
  Vec3d residual_force() const { return contacts_.residual_force(); }
  /// Work on the cloth from x0 to the candidate, of contacts, open seams and the forces that have
  /// no potential [J].
  double work() const { return contacts_.work() + outer_work_; }

 private:
  void move_freely(const SubstepContext& step);
  void renew_no_face(const SubstepContext& step);
  void linearize(SubstepContext& step);
  void find_candidate(SubstepContext& step, const Proximity& proximity, bool solved);
  int most_iterations(const ImplicitParameters& p) const;
  void solve(SubstepContext& step, const Proximity& proximity, const ContactGoal& goal,
             bool solved);
  void move(SubstepContext& step);
  void find_linearization_error(const SubstepContext& step);
  void linearize_at_candidate(const SubstepContext& step);
  ForceContext context(const SubstepContext& step) const {
    return {.mesh = step.mesh,
            .parameters = step.parameters,
            .state = step.state,
            .point = point_,
            .free_motion = free_motion_.view()};
  }

  Assembly assembly_;
  MatrixChange change_ = MatrixChange::all;  ///< of its matrix since the last solve
  ContactPasses contacts_;
  SeamSprings seams_;
  Array<Vec3r> dv_;           ///< Δv [m/s] (cloth_vertices + kPadding)
  TimeRule rule_{};           ///< of the substep, integrate
  Linearization point_{};     ///< the present one of the substep
  int iteration_ = 0;         ///< of Newton's method in the substep, 1 at x0
  Array<Vec3r> free_motion_;  ///< x1 − x0 with Δv = 0 [m] (vertices), move_freely
  Array<Vec3r>
      free_velocity_;  ///< v', where the rule remembers [m/s] (cloth_vertices), move_freely
  /// Shape and predicted motion of the linearisation, from the second iteration on [m]
  /// (cloth_vertices), linearize_at_candidate.
  Array<Vec3r> at_, predicted_;
  Array<Vec3r> free_shape_;         ///< x0 + free_motion_, where yarns have friction [m]
  Array<std::uint8_t> renewed_;     ///< see Linearization::renewed, linearize_at_candidate
  Array<std::uint8_t> to_renew_;    ///< the same for the next iteration, find_linearization_error
  double linearization_error_ = 0;  ///< find_linearization_error [N/m]
  double missed_strain_ = 0;        ///< the strain that it belongs to, find_linearization_error
  double outer_work_ = 0;           ///< of the forces [J], integrate
};

}  // namespace icloth::ICLOTH_BUILD
