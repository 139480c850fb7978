// Solves the assembled system together with the contacts, in as many passes as they need: the
// repulsion acts one way only, and friction sticks or slides. Which contacts close and which slide
// is known for certain after a solve.
#pragma once

#include "sim/linear/linear_solver.h"
#include "sim/mechanics/pattern_builder.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// The linear system of one linearisation, before its contacts are added.
struct ContactSystem {
  const BlockMatrix& matrix;  ///< without contacts
  View<const Vec3r> rhs;      ///< without contacts [N·s] (cloth_vertices)
  const Array<Contact>& contacts;
  View<const Coupling> seams;     ///< that act in every pass
  View<const Vec3r> free_motion;  ///< x1 − x0 with Δv = 0 [m] (vertices)
  Real h;                         ///< from a change of velocity to one of position [s]
};

class ContactPasses {
 public:
  /// Prepares for systems of this pattern.
  void set_up(const Pattern& pattern) { solver_.set_up(pattern.row_first, pattern.column); }

  /// Solves for Δv. `dv` has kPadding elements more than there are cloth vertices; `solved`: it is
  /// a solution of an earlier linearisation, from which the state of the contacts is taken.
  void solve(SubstepContext& step, const ContactSystem& system, View<Vec3r> dv, bool solved);

  /// Residual of the last solve, summed over all free vertices [N].
  Vec3d residual_force() const { return residual_force_; }
  /// Work of the contacts on the cloth in the last solve [J].
  double work() const { return work_; }
  /// The contacts that acted in the last solve.
  CouplingView couplings() const { return couplings_.view(); }

 private:
  void solve_once(SubstepContext& step, const ContactSystem& system, View<Vec3r> dv,
                  bool same_matrix);

  Array<ContactTerm> terms_;       ///< one for each contact
  Couplings couplings_;            ///< the terms that act
  Array<Mat3r> inverse_diagonal_;  ///< block-Jacobi (cloth_vertices)
  Array<Vec3r> rhs_;               ///< with contacts [N·s] (cloth_vertices)
  LinearSolver solver_;
  Vec3d residual_force_;
  double work_ = 0;
};

}  // namespace icloth::ICLOTH_BUILD
