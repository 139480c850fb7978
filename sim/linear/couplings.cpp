#include "sim/linear/couplings.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// A contact that is active and has no place yet.
struct NeedsPlace {
  View<const ContactTerm> terms;
  View<const Index> listed;
  ICLOTH_HD Index operator()(Index i) const {
    return terms[i].active != 0 && listed[i] == 0 ? 1 : 0;
  }
};

struct HasPlace {
  View<const ContactTerm> terms;
  View<const Index> listed;
  ICLOTH_HD bool operator()(Index i) const { return terms[i].active != 0 || listed[i] != 0; }
};

struct TakePlace {
  View<const Contact> contacts;
  View<const Index> contact;
  View<Coupling> list;
  View<Index> listed;

  ICLOTH_HD void operator()(Index i) const {
    list[i].s = contacts[contact[i]].s;
    listed[contact[i]] = 1;
  }
};

/// The terms of contacts that are not active are zero.
struct TakeTerm {
  View<const ContactTerm> terms;
  View<const Index> contact;
  View<Coupling> list;

  ICLOTH_HD void operator()(Index i) const {
    const ContactTerm& t = terms[contact[i]];
    list[i].h = t.h;
    list[i].impulse = t.impulse;
  }
};

struct Append {
  View<const Coupling> more;
  Index first;
  View<Coupling> list;

  ICLOTH_HD void operator()(Index i) const { list[first + i] = more[i]; }
};

struct CornersOfCouplings {
  SomeCouplings couplings;
  View<Int4> slots;

  ICLOTH_HD void operator()(Index i) const {
    const Index* v = couplings.list[couplings[i]].s.v;
    slots[i] = {{v[0], v[1], v[2], v[3]}};
  }
};

/// Copies the corners of couplings in the order of an incidence, with their weights.
struct TakeCorner {
  SomeCouplings couplings;
  View<const Index> entries;
  View<CouplingCorner> corners;

  ICLOTH_HD CouplingCorner at(Index k) const {
    const Index c = couplings[entries[k] / 4];
    return {c, couplings.list[c].s.w[entries[k] % 4]};
  }
  ICLOTH_HD void operator()(Index k) const { corners[k] = at(k); }
};

/// Merges the corners of each vertex that were there before with those that were added; both are
/// ascending.
struct MergeCorners {
  View<const Index> first_before, first_added;
  View<const CouplingCorner> before;
  View<const Index> moved;  ///< see CouplingChange
  TakeCorner added;
  View<const Index> first;
  View<CouplingCorner> corners;

  ICLOTH_HD void operator()(Index v) const {
    Index old = first_before[v], more = first_added[v], to = first[v];
    const Index old_end = first_before[v + 1], more_end = first_added[v + 1];
    while (old < old_end && more < more_end) {
      const CouplingCorner a{moved[before[old].coupling], before[old].weight};
      const CouplingCorner b = added.at(more);
      const bool a_first = a.coupling < b.coupling;
      corners[to++] = a_first ? a : b;
      ++(a_first ? old : more);
    }
    for (; old < old_end; ++old) corners[to++] = {moved[before[old].coupling], before[old].weight};
    for (; more < more_end; ++more) corners[to++] = added.at(more);
  }
};

struct CopyFirst {
  View<const Index> from;
  View<Index> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[i]; }
};

struct AddFirsts {
  View<const Index> a, b;
  View<Index> sum;
  ICLOTH_HD void operator()(Index i) const { sum[i] = a[i] + b[i]; }
};

/// A coupling that was not in the list before.
struct IsAdded {
  View<const Index> contact, listed;
  ICLOTH_HD bool operator()(Index c) const { return listed[contact[c]] == 0; }
};

struct NotePlaces {
  View<const Index> contact;
  View<Index> place;
  ICLOTH_HD void operator()(Index c) const { place[contact[c]] = c; }
};

/// Where the couplings of the list before are now. Those without a contact follow the others.
struct FindMoved {
  View<const Index> contact_before, place;
  Index count;  ///< of couplings with a contact
  View<Index> moved;

  ICLOTH_HD void operator()(Index c) const {
    const Index before = contact_before.size();
    moved[c] = c < before ? place[contact_before[c]] : count + (c - before);
  }
};

}  // namespace

/// Lists the corners of couplings in `incidence_`, vertex by vertex.
void CouplingCorners::list_corners(const SomeCouplings& couplings, Index vertices) {
  slots_.resize(couplings.size());
  for_each("implicit.coupling_slots", couplings.size(),
           CornersOfCouplings{couplings, slots_.view()});
  incidence_.build(slots_.view(), vertices);
}

void CouplingCorners::build(View<const Coupling> list, Index vertices) {
  const SomeCouplings all{list, {}, true};
  list_corners(all, vertices);
  const View<const Index> entries = incidence_.entries();
  first_.resize(vertices + 1);
  for_each("implicit.coupling_first", vertices + 1, CopyFirst{incidence_.first(), first_.view()});
  corners_.resize(entries.size());
  for_each("implicit.coupling_corners", entries.size(), TakeCorner{all, entries, corners_.view()});
}

void CouplingCorners::follow(const CouplingChange& change, View<const Coupling> list,
                             Index vertices) {
  const SomeCouplings added{list, change.added, false};
  list_corners(added, vertices);

  // Every list of a vertex grows by what was added to it.
  swap(first_, first_before_);
  swap(corners_, corners_before_);
  first_.resize(vertices + 1);
  for_each("implicit.coupling_first", vertices + 1,
           AddFirsts{first_before_.view(), incidence_.first(), first_.view()});
  corners_.resize(corners_before_.size() + 4 * change.added.size());
  for_each("implicit.coupling_corners", vertices,
           MergeCorners{first_before_.view(),
                        incidence_.first(),
                        corners_before_.view(),
                        change.moved,
                        {added, incidence_.entries(), {}},
                        first_.view(),
                        corners_.view()});
}

void Couplings::gather(View<const Contact> contacts, View<const ContactTerm> terms, Index vertices,
                       View<const Coupling> more) {
  if (must_lay_out(terms)) lay_out(contacts, terms, vertices, more);
  for_each("implicit.couplings", contact_.size(), TakeTerm{terms, contact_.view(), list_.view()});
}

bool Couplings::must_lay_out(View<const ContactTerm> terms) const {
  return !laid_out_ || reduce("implicit.new_couplings", terms.size(), Index{0},
                              NeedsPlace{terms, listed_.view()}, Sum{}) > 0;
}

void Couplings::lay_out(View<const Contact> contacts, View<const ContactTerm> terms, Index vertices,
                        View<const Coupling> more) {
  if (!laid_out_) {
    listed_.resize(contacts.size());
    listed_.fill(0);
  }
  const bool goes_on = laid_out_;
  laid_out_ = true;
  change_ = {};
  ++layout_;

  // Contacts come in their own order, so that sums over them do not depend on when they closed.
  swap(contact_, contact_before_);
  contact_.resize(0);
  if (contacts.size() > 0)
    compact("implicit.active_contacts", contacts.size(), HasPlace{terms, listed_.view()}, contact_);
  const Index count = contact_.size(), total = count + more.size();
  list_.resize(total);
  if (total == 0) return;
  if (goes_on) note_change(contacts.size(), more.size());
  for_each("implicit.couplings", count,
           TakePlace{contacts, contact_.view(), list_.view(), listed_.view()});
  if (more.size() > 0)
    for_each("implicit.couplings", more.size(), Append{more, count, list_.view()});
  if (change_.from != 0)
    corners_.follow(change_, list_.view(), vertices);
  else
    corners_.build(list_.view(), vertices);
}

/// Notes how the list comes from the one before. To be called while `listed_` still tells them
/// apart.
void Couplings::note_change(Index contacts, Index more) {
  const Index count = contact_.size(), before = contact_before_.size();
  if (before + more == 0) return;
  compact("implicit.added_couplings", count, IsAdded{contact_.view(), listed_.view()}, added_);
  place_.resize(contacts);
  for_each("implicit.moved_couplings", count, NotePlaces{contact_.view(), place_.view()});
  moved_.resize(before + more);
  for_each("implicit.moved_couplings", before + more,
           FindMoved{contact_before_.view(), place_.view(), count, moved_.view()});
  change_ = {.from = layout_ - 1, .moved = moved_.view(), .added = added_.view()};
}

}  // namespace icloth::ICLOTH_BUILD
