// The system that an implicit step solves, as the solver and its preconditioner see it.
#pragma once

#include "kernels/contact.h"
#include "sim/block_matrix.h"

namespace icloth::ICLOTH_BUILD {

/// y = (A + Σ contacts w wᵀ⊗H) x restricted to the free vertices. A − M, M the masses, is a sum of
/// positive semi-definite terms of at most 4 vertices each (the multilevel preconditioner counts on
/// it).
struct SystemView : MatrixView {
  View<const Real> inverse_mass;  ///< 0: prescribed, its Δv is zero
  View<const Contact> contacts;
  View<const ContactTerm> terms;
  View<const Index> contact_first, contact_entries;
};

}  // namespace icloth::ICLOTH_BUILD
