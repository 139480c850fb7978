// Shares of single elements, faces and hinges, in the system of the implicit step, and how a row of
// the matrix finds those that belong to it.
#pragma once

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// Share of one face. The blocks are symmetric, so only those on and above the diagonal are stored.
struct FaceTerm {
  Mat3r block[6];    ///< (0,0) (0,1) (0,2) (1,1) (1,2) (2,2) [kg]
  Vec3r impulse[3];  ///< right-hand side [N·s]
};

/// Place of the block of corners a ≤ b in FaceTerm::block.
ICLOTH_HD inline int block_slot(int a, int b) { return a == 0 ? b : (a == 1 ? b + 2 : 5); }

/// Share of one hinge: blocks stiffness · g_a g_bᵀ and impulses impulse · g_a, with g the gradient
/// of its angle.
struct HingeTerm {
  Vec3r gradient[4];  ///< ∂θ/∂x_a [1/m]
  Real stiffness;     ///< [kg m²]
  Real impulse;       ///< [N·m·s]
};

/// Names the block (row, column) of an element with kCorners vertices. One number, because the
/// lists of sources are read in every assembly.
template <int kCorners>
struct ElementBlock {
  Index number;

  static ElementBlock of(Index element, int row, int column) {
    return {kCorners * kCorners * element + kCorners * row + column};
  }
  ICLOTH_HD Index element() const { return number / (kCorners * kCorners); }
  ICLOTH_HD int row() const { return number % (kCorners * kCorners) / kCorners; }
  ICLOTH_HD int column() const { return number % kCorners; }
};

template <int kCorners>
struct SourceView {
  View<const Index> first;   ///< (stored blocks + 1)
  View<const Index> number;  ///< see ElementBlock, ascending for each stored block

  /// Calls f(source) for the sources of a stored block, in ascending order.
  template <class F>
  ICLOTH_HD void of_block(Index block, const F& f) const {
    for (Index e = first[block]; e < first[block + 1]; ++e) f(ElementBlock<kCorners>{number[e]});
  }

  /// Whether an element that adds to a stored block is flagged, or any at all where no element has
  /// a flag.
  ICLOTH_HD bool flagged(Index block, View<const std::uint8_t> flag) const {
    bool found = false;
    of_block(block, [&](ElementBlock<kCorners> source) {
      found = found || flag.size() == 0 || flag[source.element()] != 0;
    });
    return found;
  }
};

/// Which blocks of one kind of element add up to each stored block. Written by PatternBuilder.
struct ElementSources {
  Array<Index> first, number;  ///< see SourceView

  template <int kCorners>
  SourceView<kCorners> view() const {
    return {first.view(), number.view()};
  }
};

/// A stored block of the matrix in the pass over its rows.
struct RowBlock {
  Index row;
  Index block;    ///< number of the stored block
  bool diagonal;  ///< the block (row, row), with which the right-hand side is added up as well
};

/// Adds the shares of all faces to one stored block.
struct FaceRows {
  SourceView<3> sources;
  View<const FaceTerm> term;
  View<const std::uint8_t> renewed;  ///< terms that the last pass wrote; empty: all (faces)

  /// Whether the row of a diagonal block has a term that the last pass wrote.
  ICLOTH_HD bool renews(Index diagonal) const { return sources.flagged(diagonal, renewed); }

  ICLOTH_HD void add(const RowBlock& at, Mat3r& sum, Vec3r& impulse) const {
    sources.of_block(at.block, [&](ElementBlock<3> source) {
      const FaceTerm& t = term[source.element()];
      const int a = source.row(), b = source.column();
      sum += a <= b ? t.block[block_slot(a, b)] : transpose(t.block[block_slot(b, a)]);
      if (at.diagonal) impulse += t.impulse[a];
    });
  }
};

/// Adds the shares of all hinges to one stored block.
struct HingeRows {
  SourceView<4> sources;
  View<const HingeTerm> term;
  View<const std::uint8_t> renewed;  ///< terms that the last passes wrote; empty: all (hinges)

  /// Whether the row of a diagonal block has a term that the last passes wrote.
  ICLOTH_HD bool renews(Index diagonal) const { return sources.flagged(diagonal, renewed); }

  ICLOTH_HD void add(const RowBlock& at, Mat3r& sum, Vec3r& impulse) const {
    sources.of_block(at.block, [&](ElementBlock<4> source) {
      const HingeTerm& t = term[source.element()];
      const int a = source.row(), b = source.column();
      sum += outer(t.stiffness * t.gradient[a], t.gradient[b]);
      if (at.diagonal) impulse += t.impulse * t.gradient[a];
    });
  }
};

}  // namespace icloth::ICLOTH_BUILD
