// One row of a product with a symmetric block-sparse matrix that stores its upper half.
#pragma once

#include "kernels/lanes.h"
#include "kernels/parallel/array.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// Number of elements by which matrix and vectors of the solver are allocated beyond their content.
inline constexpr Index kPadding = 1;

/// A symmetric matrix of 3×3 blocks: the blocks (i, j) with j ≥ i, rows of ascending columns, each
/// with its diagonal block first.
struct MatrixView {
  View<const Index> row_first, column;                       ///< (rows + 1), (blocks)
  View<const Index> lower_first, lower_column, lower_block;  ///< see BlockMatrix
  const Real* entries;  ///< 9 a block, row-major, readable kPadding blocks beyond the end
};

/// Number of blocks by which a row prefetches: rows are too short for the processor to see by
/// itself that the next ones follow on in memory. 80 was the fastest of 40, 80 and 192 for matrices
/// larger than the cache, and it costs little where the matrix fits into it.
inline constexpr std::ptrdiff_t kBlocksAhead = 80;

/// The blocks of a row times their parts of a vector: three dot products, summed up lane by lane.
/// Three numbers are read as four, so that each row of a block takes one vector multiplication; the
/// fourth number is not used.
struct BlockRowSum {
  Lanes row0{}, row1{}, row2{};

  ICLOTH_HD void add(const Real* block, const Real* numbers) {
    const Lanes v = load_lanes(numbers);
    row0 += load_lanes(block) * v;
    row1 += load_lanes(block + 3) * v;
    row2 += load_lanes(block + 6) * v;
  }
  /// The lanes are added up last.
  ICLOTH_HD Vec3r total() const {
    return {row0[0] + row0[1] + row0[2], row1[0] + row1[1] + row1[2], row2[0] + row2[1] + row2[2]};
  }
};

/// Row i of the product with a vector of 3 numbers a row, readable kPadding rows beyond its end.
/// Every stored block serves two rows.
ICLOTH_HD inline Vec3r multiply_row(const MatrixView& matrix, Index i, const Real* numbers) {
  // The stored blocks of the row itself.
  BlockRowSum row;
  for (Index k = matrix.row_first[i]; k < matrix.row_first[i + 1]; ++k) {
    const Real* m = matrix.entries + 9 * static_cast<std::ptrdiff_t>(k);
    prefetch(m, 9 * kBlocksAhead);
    row.add(m, numbers + 3 * static_cast<std::ptrdiff_t>(matrix.column[k]));
  }

  // The blocks below the diagonal are stored in other rows. They act transposed: their rows are
  // added up, weighted by the numbers of the vector. Three sums that do not wait for each other
  // keep the processor busy.
  Lanes weighted0{}, weighted1{}, weighted2{};
  for (Index k = matrix.lower_first[i]; k < matrix.lower_first[i + 1]; ++k) {
    const Real* m = matrix.entries + 9 * static_cast<std::ptrdiff_t>(matrix.lower_block[k]);
    const Real* v = numbers + 3 * static_cast<std::ptrdiff_t>(matrix.lower_column[k]);
    weighted0 += load_lanes(m) * v[0];
    weighted1 += load_lanes(m + 3) * v[1];
    weighted2 += load_lanes(m + 6) * v[2];
  }
  const Lanes columns = weighted0 + weighted1 + weighted2;

  return row.total() + Vec3r{columns[0], columns[1], columns[2]};
}

}  // namespace icloth::ICLOTH_BUILD
