// Solves the assembled system together with the contacts, in as many passes as they need: the
// repulsion acts one way only, and friction sticks or slides. Which contacts close and which slide
// is known for certain after a solve.
#pragma once

#include "sim/linear/linear_solver.h"
#include "sim/mechanics/line_search.h"
#include "sim/mechanics/pattern_builder.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

/// The linear system of one linearisation, before its contacts are added.
struct ContactSystem {
  const BlockMatrix& matrix;  ///< without contacts
  View<const Vec3r> rhs;      ///< without contacts [N·s] (cloth_vertices)
  const Array<Contact>& contacts;
  View<const Coupling> seams;               ///< that act in every pass
  View<const Vec3r> free_motion;            ///< x1 − x0 with Δv = 0 [m] (vertices)
  Real h;                                   ///< from a change of velocity to one of position [s]
  MatrixChange change = MatrixChange::all;  ///< of the matrix since the last system
  View<const std::uint8_t> changed_rows{};  ///< see SolveOptions (cloth_vertices)
};

/// How well a system is to be solved.
struct ContactGoal {
  double contact_tolerance;  ///< share of the load with which contacts may be wrong; 0: all passes
  double cg_tolerance;       ///< ‖b − A Δv‖₂ / ‖b‖₂
};

class ContactPasses {
 public:
  /// Prepares for systems of this pattern.
  void set_up(const Pattern& pattern) { solver_.set_up(pattern.row_first, pattern.column); }

  /// Solves for Δv up to the goal. `dv` has kPadding elements more than there are cloth vertices;
  /// `solved`: it is a solution of an earlier linearisation, from which the state of the contacts
  /// is taken.
  void solve(SubstepContext& step, const ContactSystem& system, const ContactGoal& goal,
             View<Vec3r> dv, bool solved);

  /// Residual of the last solve, ‖b − A Δv‖₂ / ‖b‖₂.
  double residual() const { return result_.residual; }
  /// Residual of the last solve, summed over all free vertices [N].
  Vec3d residual_force() const { return residual_force_; }
  /// Work of the contacts on the cloth in the last solve [J].
  double work() const { return work_; }
  /// The contacts that acted in the last solve.
  CouplingView couplings() const { return couplings_.view(); }

 private:
  struct PassResult {
    bool exact = false;   ///< solved to the full tolerance, and gone all the way
    double residual = 0;  ///< ‖b − A Δv‖₂ / ‖b‖₂
  };

  void start(SubstepContext& step, const ContactSystem& system, const VertexMotion& motion,
             View<const Vec3r> dv, bool solved);
  PassResult correct(SubstepContext& step, const ContactSystem& system, const ContactLine& line,
                     View<Vec3r> dv, double cg_tolerance, double loose, bool later);

  Array<ContactTerm> terms_;       ///< one for each contact
  Array<ContactTravel> travels_;   ///< (contacts)
  Couplings couplings_;            ///< the terms that act
  Array<Vec3r> force_;             ///< of each coupling at the present Δv [N·s]
  Array<Vec3r> residual_;          ///< b − A Δv without contacts [N·s] (cloth_vertices)
  Array<Vec3r> g_;                 ///< the same with contacts [N·s] (cloth_vertices)
  Array<Vec3r> d_;                 ///< correction of Δv [m/s] (cloth_vertices + kPadding)
  Array<Mat3r> inverse_diagonal_;  ///< block-Jacobi (cloth_vertices)
  LinearSolver solver_;
  MatrixChange change_ = MatrixChange::all;  ///< of the matrix since the solver last saw it
  LineSearch line_search_;
  PassResult result_;  ///< of the last pass
  Vec3d residual_force_;
  double work_ = 0;
};

}  // namespace icloth::ICLOTH_BUILD
