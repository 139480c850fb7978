// Preconditioned conjugate gradients on 3×3 blocks; contacts are applied without assembling them.
#pragma once

#include "kernels/parallel/parallel.h"
#include "sim/linear/hierarchy.h"
#include "sim/scene/parameters.h"

namespace icloth::ICLOTH_BUILD {

struct LinearSolution {
  Index iterations = 0;
  double residual = 0;  ///< ‖b − Ax‖₂ / ‖b‖₂, computed anew at the end
  Vec3d residual_sum;   ///< Σ over the rows of b − Ax, computed anew [N·s]
  double bytes = 0;     ///< that the iterations had to read and write at least
};

/// How the matrix of a system differs from that of the last solve, contacts left out.
enum class MatrixChange {
  none,
  some_rows,  ///< in rows that are named
  all,
};

struct SolveOptions {
  Preconditioner preconditioner;
  double tolerance;  ///< of LinearSolution::residual, whatever the preconditioner
  int max_iterations;
  MatrixChange change = MatrixChange::all;
  View<const std::uint8_t> changed_rows{};  ///< 1: may differ, 0: the same; of some_rows (rows)
};

class LinearSolver {
 public:
  /// Prepares for systems whose matrix has this pattern (see BlockMatrix::set_pattern).
  void set_up(const std::vector<Index>& row_first, const std::vector<Index>& column) {
    hierarchy_.set_up(row_first, column);
  }

  /// Solves for x (Δv), starting from the numbers that it holds. `inverse_diagonal` holds the
  /// inverse diagonal blocks of the whole system, 0 for prescribed vertices (rows). `padded` is x
  /// with kPadding elements more than b. The result is never further from the solution, by its
  /// residual, than the start.
  LinearSolution solve(const SystemView& system, View<const Mat3r> inverse_diagonal,
                       View<const Vec3r> b, View<Vec3r> padded, const SolveOptions& options);

  /// The system times the solution of the last solve, and H Σ w x of each coupling in it. Valid
  /// until the next solve, unless its right-hand side was zero.
  View<const Vec3r> product() const { return q_.view(); }
  View<const Vec3r> coupling_products() const { return contact_.view(); }

 private:
  Hierarchy hierarchy_;
  Array<Vec3r> r_, z_, p_, q_, best_;
  Array<Vec3r> contact_;  ///< H Σ w p of each coupling
  Array<LinearSolution> solution_;
};

}  // namespace icloth::ICLOTH_BUILD
