// The system that an implicit step solves, as the solver and its preconditioner see it.
#pragma once

#include "sim/linear/couplings.h"
#include "sim/linear/matrix_pattern.h"

namespace icloth::ICLOTH_BUILD {

/// The operator y = (A + Σ couplings w wᵀ⊗H) x, restricted to the free vertices. With M the masses,
/// A − M is a sum of positive semi-definite terms of at most 4 vertices each, which the multilevel
/// preconditioner relies on.
struct SystemView : MatrixView {
  View<const Real> inverse_mass;  ///< 0: prescribed, its Δv is zero
  CouplingView couplings;
};

}  // namespace icloth::ICLOTH_BUILD
