// One row of a product with a symmetric block-sparse matrix that stores its upper half.
#pragma once

#include "kernels/lanes.h"
#include "kernels/parallel/array.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// Elements that matrix and vectors of the solver are allocated beyond their content.
inline constexpr Index kPadding = 1;

/// Blocks (i, j) with j ≥ i, rows of ascending columns, the diagonal block first.
struct MatrixView {
  View<const Index> row_first, column;                       ///< (rows + 1), (blocks)
  View<const Index> lower_first, lower_column, lower_block;  ///< see BlockMatrix
  const Real* entries;  ///< 9 a block, row-major, readable kPadding blocks beyond the end
};

/// Blocks that a row asks for ahead of time: rows are too short for the processor to see by itself
/// that the next ones follow on. Of the time without, a product alone on 25 MB takes 0.70 with 40,
/// 0.59 with 80 and 0.72 with 192; one that stays in the cache takes 1.07 with 80.
inline constexpr std::ptrdiff_t kBlocksAhead = 80;

/// Row i of the product with a vector of 3 numbers a row, readable kPadding rows beyond its end;
/// every stored block serves two rows.
ICLOTH_HD inline Vec3r multiply_row(const MatrixView& matrix, Index i, const Real* numbers) {
  // Three numbers a row are read as four: one vector multiplication. The fourth is not used.
  Lanes row0{}, row1{}, row2{}, columns{};
  for (Index k = matrix.row_first[i]; k < matrix.row_first[i + 1]; ++k) {
    const Real* m = matrix.entries + 9 * static_cast<std::ptrdiff_t>(k);
    prefetch(m, 9 * kBlocksAhead);
    const Lanes v = load_lanes(numbers + 3 * static_cast<std::ptrdiff_t>(matrix.column[k]));
    row0 += load_lanes(m) * v;
    row1 += load_lanes(m + 3) * v;
    row2 += load_lanes(m + 6) * v;
  }
  for (Index k = matrix.lower_first[i]; k < matrix.lower_first[i + 1]; ++k) {
    const Real* m = matrix.entries + 9 * static_cast<std::ptrdiff_t>(matrix.lower_block[k]);
    const Real* v = numbers + 3 * static_cast<std::ptrdiff_t>(matrix.lower_column[k]);
    columns += load_lanes(m) * v[0];
    columns += load_lanes(m + 3) * v[1];
    columns += load_lanes(m + 6) * v[2];
  }
  return {row0[0] + row0[1] + row0[2] + columns[0], row1[0] + row1[1] + row1[2] + columns[1],
          row2[0] + row2[1] + row2[2] + columns[2]};
}

}  // namespace icloth::ICLOTH_BUILD
