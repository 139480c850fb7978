// The contacts of the implicit step that act, packed for the solver, which goes through them in
// every iteration: most pairs in proximity are apart and do not act.
#pragma once

#include "kernels/contact.h"
#include "sim/linear/incidence.h"

namespace icloth::ICLOTH_BUILD {

/// A contact as the system sees it: w wᵀ⊗H on the left, w impulse on the right.
struct Coupling {
  Stencil s;
  Symmetric h;
  Vec3r impulse;

  /// Whether it adds anything: a contact that has opened again since it got its place does not.
  ICLOTH_HD bool acts() const { return h.m[0] + h.m[3] + h.m[5] > 0; }

  /// Σ w v over the corners among the first `vertices`, those of the cloth.
  ICLOTH_HD Vec3r of_cloth(View<const Vec3r> v, Index vertices) const {
    Vec3r sum{};
    for (int a = 0; a < 4; ++a)
      if (s.v[a] < vertices) sum += s.w[a] * v[s.v[a]];
    return sum;
  }
};

/// The couplings of a list, all of them or those that a second list names.
struct SomeCouplings {
  View<const Coupling> list;
  View<const Index> chosen;
  bool all;

  ICLOTH_HD Index size() const { return all ? list.size() : chosen.size(); }
  ICLOTH_HD Index operator[](Index i) const { return all ? i : chosen[i]; }
};

/// A corner of a coupling, as the list of its vertex has it.
struct CouplingCorner {
  Index coupling;
  Real weight;
};

/// How a list of couplings came from the one before, for those who keep sorted lists of them.
struct CouplingChange {
  std::uint64_t from = 0;     ///< layout before; 0: nothing is left of it
  View<const Index> moved{};  ///< where each coupling of that list is now, ascending
  View<const Index> added{};  ///< couplings that were not in it, ascending
};

struct CouplingView {
  View<const Coupling> list;
  View<const Index> first;             ///< corner of each vertex; not read where the list is empty
  View<const CouplingCorner> corners;  ///< vertex by vertex, couplings ascending
  std::uint64_t layout = 0;  ///< equal numbers of one Couplings have the same stencils; 0: unknown
  CouplingChange change{};   ///< to this layout

  Index size() const { return list.size(); }

  /// Calls f(c, w) for the couplings c of a vertex, ascending, where w is its weight there.
  template <class F>
  ICLOTH_HD void of_vertex(Index i, const F& f) const {
    if (list.size() == 0) return;
    for (Index k = first[i]; k < first[i + 1]; ++k) f(corners[k].coupling, corners[k].weight);
  }

  /// Whether a vertex is a corner of any coupling, whatever that adds.
  ICLOTH_HD bool hold(Index i) const { return list.size() > 0 && first[i] < first[i + 1]; }

  ICLOTH_HD bool touch(Index i) const {
    bool found = false;
    of_vertex(i, [&](Index c, Real) { found = found || list[c].acts(); });
    return found;
  }
};

/// The corners of couplings, vertex by vertex. The solver goes through them in every iteration, and
/// in this order it reads one stream instead of a cache line of the list for each corner.
class CouplingCorners {
 public:
  void build(View<const Coupling> list, Index vertices);
  /// Takes the list that came from the one before by a change.
  void follow(const CouplingChange& change, View<const Coupling> list, Index vertices);
  View<const Index> first() const { return first_.view(); }
  View<const CouplingCorner> view() const { return corners_.view(); }

 private:
  void list_corners(const SomeCouplings& couplings, Index vertices);

  Array<Int4> slots_;
  Incidence incidence_;  ///< of all couplings, build, or of those that were added, follow
  Array<Index> first_, first_before_;
  Array<CouplingCorner> corners_, corners_before_;
};

class Couplings {
 public:
  /// Forgets the contacts. To be called whenever `contacts`, `vertices` or `more` of gather change.
  void clear() { laid_out_ = false; }

  /// Takes the contacts whose terms are active, and after them `more`. Contacts that it took since
  /// the last clear() keep their places, with nothing in them while they are not active, so that
  /// the lists need not be made again in every pass. `vertices` is the number of cloth vertices;
  /// corners from there on belong to obstacles and are left out of the lists of vertices.
  void gather(View<const Contact> contacts, View<const ContactTerm> terms, Index vertices,
              View<const Coupling> more = {});

  CouplingView view() const {
    return {list_.view(), corners_.first(), corners_.view(), layout_, change_};
  }

 private:
  bool must_lay_out(View<const ContactTerm> terms) const;
  void lay_out(View<const Contact> contacts, View<const ContactTerm> terms, Index vertices,
               View<const Coupling> more);
  void note_change(Index contacts, Index more);

  bool laid_out_ = false;
  std::uint64_t layout_ = 0;
  Array<Index> listed_;                    ///< 1: it has a place in the list (contacts)
  Array<Index> contact_, contact_before_;  ///< of each coupling, ascending
  Array<Index> place_;                     ///< in the list, of contacts that have one (contacts)
  Array<Index> moved_, added_;             ///< see CouplingChange
  CouplingChange change_;
  Array<Coupling> list_;
  CouplingCorners corners_;
};

}  // namespace icloth::ICLOTH_BUILD
