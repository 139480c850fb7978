// Stage 2: backward Euler (paper Section 2.4; Baraff and Witkin 1998) or BDF2, linearised at x̂: x0
// first, then where the last solve ended, while the linearisation is wrong (Newton).
//
//   [M + h(h+d)K + contacts + springs + air] Δv = h [f(x̂) + f_ext − K (x' + h v' − x̂ + d v')]
//   x1 = x' + h (v' + Δv)                      h, x', v': sim/mechanics/time_rule.h; Euler: dt, x0,
//   v
//
// K: positive semi-definite stiffness of membrane and bending at x̂, with the measured fabric's
// coefficients frozen at x0; d: stiffness-proportional damping [s]. f and K have the friction
// between yarns as well, without d (sim/mechanics/elastic_terms.h, Linearization).
#pragma once

#include "sim/collision/proximity.h"
#include "sim/linear/linear_solver.h"
#include "sim/mechanics/plate_terms.h"
#include "sim/mechanics/time_rule.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

class Implicit {
 public:
  /// Lays out the matrix: one block for each pair of vertices that a face or a hinge couples.
  /// Without `bending` those of faces alone.
  void set_up(const World& world, bool bending);

  /// Writes state.candidate and the cloth part of state.x1.
  void integrate(SubstepContext& step, const Proximity& proximity);

  /// Velocities at the end of the substep x0 → x1, and what the next one goes on from.
  void finish_substep(State& state);

  /// Largest error of the tension that the last linearisation made [N/m].
  double linearization_error() const { return linearization_error_; }
  /// What the residual of the last solve is short of the forces, over all free vertices [N].
  Vec3d lost_force() const { return lost_force_; }
  /// Work of air, hands, contacts and yarn friction on the cloth from x0 to the candidate [J].
  double work() const { return contact_work_ + outer_work_; }

 private:
  void assemble(SubstepContext& step, const Linearization& point);
  /// v' of the rule [m/s] (vertices); writes free_motion_.
  View<const Vec3r> move_freely(const SubstepContext& step);
  void solve_with_contacts(SubstepContext& step, const Proximity& proximity, bool solved);
  double move(SubstepContext& step, const Linearization& point);
  void bend(SubstepContext& step, const Linearization& point);

  BlockMatrix matrix_;
  /// Which element blocks add up to a stored block: 9·face + 3a + b, 16·hinge + 4a + b.
  Array<Index> face_source_first_, face_source_, hinge_source_first_, hinge_source_;
  Array<FaceTerm> face_terms_;           ///< (cloth_faces), assemble
  Array<HingeTerm> hinge_terms_;         ///< (hinges), bend
  Array<PlateTerm> plate_terms_;         ///< (cloth_faces), bend
  Array<ContactTerm> contact_terms_;     ///< of every pair in proximity
  Couplings couplings_;                  ///< those of them that acted in the last solve
  Array<Mat3r> inverse_diagonal_;        ///< block-Jacobi (cloth_vertices)
  Array<Vec3r> rhs_, contact_rhs_, dv_;  ///< without and with contacts; Δv (cloth_vertices)
  TimeRule rule_{};                      ///< of the substep, integrate
  Array<Vec3r> free_motion_;             ///< x1 − x0 with Δv = 0 [m] (vertices)
  Array<Vec3r> free_velocity_;           ///< v', where the rule remembers [m/s] (cloth_vertices)
  Array<Vec3r> at_,
      predicted_;  ///< of the linearisation, from the second iteration (cloth_vertices)
  double linearization_error_ = 0;
  Vec3d lost_force_;
  double contact_work_ = 0, outer_work_ = 0;  ///< [J], the latter of air, hands and yarns
  LinearSolver solver_;
};

}  // namespace icloth::ICLOTH_BUILD
