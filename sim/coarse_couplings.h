// What the couplings add to the finest level of the multilevel preconditioner: Pᵀ (Σ w wᵀ⊗H) P.
// Layers that lie on each other can move together at no cost; couplings lumped on the diagonal
// would hold each of them in place.
#pragma once

#include "sim/linear_system.h"

namespace icloth::ICLOTH_BUILD {

/// One of the node pairs that a coupling adds weight × H to.
struct CoarseTerm {
  std::uint64_t key;  ///< row and column, see NodeKey
  Index coupling;
  Real weight;
};

class CoarseCouplings {
 public:
  /// group: node of each vertex (vertices).
  void fill(const SystemView& system, View<const Index> group, Index nodes);

  /// Blocks of row i: first[i] … first[i + 1] − 1, columns ascending, the diagonal among them. No
  /// rows at all without couplings.
  View<const Index> first() const { return first_.view(); }
  View<const Index> node() const { return node_.view(); }
  View<const Mat3r> value() const { return value_.view(); }

 private:
  Array<CoarseTerm> found_, terms_;  ///< the latter sorted by key
  SortedAppend append_sorted_;
  Array<Index> starts_;  ///< first term of each block
  Array<Index> first_, node_;
  Array<Mat3r> value_;
};

}  // namespace icloth::ICLOTH_BUILD
