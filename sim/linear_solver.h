// Preconditioned conjugate gradients on 3×3 blocks; contacts are applied without assembling them.
#pragma once

#include "kernels/contact.h"
#include "kernels/parallel.h"

namespace icloth::ICLOTH_BUILD {

/// Elements that matrix and vectors of the solver are allocated beyond their content.
inline constexpr Index kPadding = 1;

/// Symmetric block-sparse matrix with a fixed pattern: blocks (i, j) with j ≥ i, rows of ascending
/// columns, the diagonal block first. Half the bytes, and bytes are what a product costs.
struct BlockMatrix {
  Array<Index> row_first;  ///< (rows + 1)
  Array<Index> column;     ///< (blocks)
  Array<Mat3r> value;      ///< (blocks + kPadding)
  /// The blocks left of the diagonal: those of other rows, to be transposed.
  Array<Index> lower_first;   ///< (rows + 1)
  Array<Index> lower_column;  ///< (blocks − rows)
  Array<Index> lower_block;   ///< number of the stored block (lower_column, row)

  /// Works out the lower lists from row_first and column on the host.
  void set_pattern(const std::vector<Index>& first, const std::vector<Index>& columns);
};

/// y = (A + Σ contacts w wᵀ⊗H) x restricted to the free vertices.
struct SystemView {
  View<const Index> row_first, column, lower_first, lower_column, lower_block;
  const Real* entries;            ///< 9 a block, row-major, readable kPadding blocks beyond the end
  View<const Real> inverse_mass;  ///< 0: prescribed, its Δv is zero
  View<const Contact> contacts;
  View<const ContactTerm> terms;
  View<const Index> contact_first, contact_entries;
};

struct LinearSolution {
  Index iterations = 0;
  double residual = 0;  ///< ‖b − Ax‖₂ / ‖b‖₂, computed anew at the end
  double bytes = 0;     ///< that the iterations had to read and write at least
};

class LinearSolver {
 public:
  /// Solves for x (Δv), starting from what it holds; `inverse_diagonal`: block-Jacobi
  /// preconditioner (rows). x is given with kPadding elements more than b.
  LinearSolution solve(const SystemView& system, View<const Mat3r> inverse_diagonal,
                       View<const Vec3r> b, View<Vec3r> padded, double tolerance,
                       int max_iterations);

 private:
  Array<Vec3r> r_, z_, p_, q_;
  Array<Vec3r> contact_;  ///< H Σ w p of each contact
  Array<LinearSolution> solution_;
};

}  // namespace icloth::ICLOTH_BUILD
