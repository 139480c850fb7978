// The contacts that act in a pass of the implicit step, packed for the solver, which goes through
// them in every iteration: most pairs in proximity are apart and do not act.
#pragma once

#include "kernels/contact.h"
#include "sim/linear/incidence.h"

namespace icloth::ICLOTH_BUILD {

/// A contact as the system sees it: w wᵀ⊗H on the left, w impulse on the right.
struct Coupling {
  Stencil s;
  Symmetric h;
  Vec3r impulse;
};

struct CouplingView {
  View<const Coupling> list;
  View<const Index> first, entries;  ///< see Incidence; not read where the list is empty

  Index size() const { return list.size(); }

  /// Calls f(c, w) for the couplings c of a vertex, ascending, where w is its weight there.
  template <class F>
  ICLOTH_HD void of_vertex(Index i, const F& f) const {
    if (list.size() == 0) return;
    for (Index k = first[i]; k < first[i + 1]; ++k)
      f(entries[k] / 4, list[entries[k] / 4].s.w[entries[k] % 4]);
  }

  ICLOTH_HD bool touch(Index i) const { return list.size() > 0 && first[i] < first[i + 1]; }
};

class Couplings {
 public:
  /// Takes the contacts whose terms are active, and after them `more`. `vertices` is the number of
  /// cloth vertices; corners from there on belong to obstacles and are left out of the lists of
  /// vertices.
  void gather(View<const Contact> contacts, View<const ContactTerm> terms, Index vertices,
              View<const Coupling> more = {});

  CouplingView view() const { return {list_.view(), incidence_.first(), incidence_.entries()}; }

 private:
  Array<Index> active_;
  Array<Coupling> list_;
  Array<Int4> slots_;
  Incidence incidence_;
};

}  // namespace icloth::ICLOTH_BUILD
