// The symmetric block-sparse matrix of the implicit stage and of the levels of its preconditioner.
#pragma once

#include <vector>

#include "kernels/block_matrix.h"

namespace icloth::ICLOTH_BUILD {

/// A symmetric matrix of 3×3 blocks with a fixed pattern: the blocks (i, j) with j ≥ i, rows of
/// ascending columns, the diagonal block first. Storing one half takes half the bytes, and bytes
/// are the cost of a product.
struct BlockMatrix {
  Array<Index> row_first;  ///< (rows + 1)
  Array<Index> column;     ///< (blocks)
  Array<Mat3r> value;      ///< (blocks + kPadding)
  /// The blocks left of the diagonal are those of other rows, to be transposed.
  Array<Index> lower_first;   ///< (rows + 1)
  Array<Index> lower_column;  ///< (blocks − rows)
  Array<Index> lower_block;   ///< number of the stored block (lower_column, row)

  /// Works out the lower lists from row_first and column on the host.
  void set_pattern(const std::vector<Index>& first, const std::vector<Index>& columns);

  MatrixView view() const;
};

}  // namespace icloth::ICLOTH_BUILD
