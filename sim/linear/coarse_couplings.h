// The share of the couplings in the finest level of the multilevel preconditioner: Pᵀ (Σ w wᵀ⊗H) P.
// Layers that lie on each other can move together at no cost; couplings lumped on the diagonal
// would hold each of them in place.
#pragma once

#include "kernels/multilevel.h"
#include "sim/linear/linear_system.h"

namespace icloth::ICLOTH_BUILD {

/// One of the node pairs to which a coupling adds weight × H.
struct CoarseTerm {
  std::uint64_t key;  ///< row and column
  Index coupling;
  Real weight;
};

class CoarseCouplings {
 public:
  /// Makes the rows from the couplings of the system. `group` is the node of each vertex
  /// (vertices). While the layout of the couplings stays, so must the prescribed vertices; only the
  /// numbers are renewed then.
  void fill(const SystemView& system, View<const Index> group, Index nodes);

  /// The rows; there are none without couplings. Valid until the next fill.
  CoarseRows rows() const {
    return {first_.view(), column_.view(), value_.view().sub(0, column_.size())};
  }

 private:
  void lay_out(const SystemView& system, View<const Index> group, Index nodes);
  void sort_terms(const SystemView& system, View<const Index> group);
  void merge_terms(const SystemView& system, View<const Index> group);

  std::uint64_t layout_ = 0;          ///< of the couplings, see CouplingView
  Array<CoarseTerm> found_, terms_;   ///< the latter sorted by key
  Array<CoarseTerm> before_, added_;  ///< sorted too, merge_terms
  SortedAppend append_sorted_;
  Array<Index> starts_;  ///< first term of each block
  Array<Index> first_, column_;
  Array<Mat3r> value_;  ///< (blocks + kPadding)
};

}  // namespace icloth::ICLOTH_BUILD
