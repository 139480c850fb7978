// The levels of the multilevel preconditioner (kernels/multilevel.h): laid out once from the
// pattern of the matrix, filled with numbers for every system.
#pragma once

#include "kernels/multilevel.h"
#include "sim/linear/coarse_couplings.h"

namespace icloth::ICLOTH_BUILD {

/// A block of the finer level that adds to a block of a coarser one.
struct BlockSource {
  Index block;       ///< its number in the finer level's storage
  Index transposed;  ///< 1: it adds its transpose, as it lies below the diagonal; 0: itself
};

class Hierarchy {
 public:
  /// Lays out the levels for a pattern, given as the upper half of the matrix with the diagonal
  /// first in each row. Groups follow from the pattern alone, so vertices can become prescribed and
  /// free again.
  void set_up(const std::vector<Index>& row_first, const std::vector<Index>& column);

  /// Sums up the matrices of the levels without contacts: (A − M) / kOverestimate + M at each.
  /// `renewed`: 1 where a row differs from that of the call before, else 0; empty: all may (rows).
  void fill_matrix(const SystemView& system, View<const std::uint8_t> renewed = {});
  /// Adds the couplings, in place of those of the call before. On the finest level they act as they
  /// are; on the others they are lumped on the diagonal blocks.
  void fill_contacts(const SystemView& system);

  /// The preconditioner for the present numbers. `inverse_diagonal` belongs to the finest matrix.
  /// Valid until the next call of a member.
  Multilevel view(const SystemView& system, View<const Mat3r> inverse_diagonal);

  /// The bytes that one application reads and writes at least.
  double bytes() const;

 private:
  using Level = Multilevel::Level;

  int levels_ = 0;
  Level level_[Multilevel::kMaxLevels]{};
  Level blocks_[Multilevel::kMaxLevels]{};             ///< of the level's matrix in matrix_
  Array<Index> group_, child_first_, child_, parent_;  ///< see Multilevel
  Array<Index> vertex_row_;                            ///< row of each block of the system's matrix
  Array<Index> node_row_;                              ///< row of each block of matrix_
  BlockMatrix matrix_;
  Array<Index> source_first_;    ///< first source of each block of matrix_, and the end
  Array<BlockSource> source_;    ///< the finer blocks that add up to each block of matrix_
  Array<std::uint8_t> renewed_;  ///< 1: a row below the node was renewed (nodes), fill_matrix
  Array<Real> mass_;             ///< of the free vertices (nodes), fill_matrix
  Array<Mat3r> diagonal_;        ///< blocks without contacts (nodes), fill_matrix
  CoarseCouplings coupled_;      ///< of the finest level, fill_contacts
  Array<Mat3r> lumped_;          ///< couplings on each node (nodes), fill_contacts
  Array<Mat3r> smoother_;        ///< see Multilevel (nodes), fill_contacts
  Array<Vec3r> b_, z_, t_;
};

}  // namespace icloth::ICLOTH_BUILD
