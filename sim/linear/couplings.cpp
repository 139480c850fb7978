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
  View<Int4> slots;
  View<Index> listed;

  ICLOTH_HD void operator()(Index i) const {
    const Stencil& s = contacts[contact[i]].s;
    list[i].s = s;
    slots[i] = {{s.v[0], s.v[1], s.v[2], s.v[3]}};
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
  View<Int4> slots;

  ICLOTH_HD void operator()(Index i) const {
    const Stencil& s = more[i].s;
    list[first + i] = more[i];
    slots[first + i] = {{s.v[0], s.v[1], s.v[2], s.v[3]}};
  }
};

struct TakeCorner {
  View<const Coupling> list;
  View<const Index> entries;
  View<CouplingCorner> corners;

  ICLOTH_HD void operator()(Index k) const {
    const Index c = entries[k] / 4;
    corners[k] = {c, list[c].s.w[entries[k] % 4]};
  }
};

}  // namespace

void CouplingCorners::build(View<const Coupling> list, View<const Int4> slots, Index vertices) {
  incidence_.build(slots, vertices);
  const View<const Index> entries = incidence_.entries();
  corners_.resize(entries.size());
  for_each("implicit.coupling_corners", entries.size(), TakeCorner{list, entries, corners_.view()});
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
  laid_out_ = true;
  ++layout_;

  // Contacts come in their own order, so that sums over them do not depend on when they closed.
  contact_.resize(0);
  if (contacts.size() > 0)
    compact("implicit.active_contacts", contacts.size(), HasPlace{terms, listed_.view()}, contact_);
  const Index count = contact_.size(), total = count + more.size();
  list_.resize(total);
  slots_.resize(total);
  if (total == 0) return;
  for_each("implicit.couplings", count,
           TakePlace{contacts, contact_.view(), list_.view(), slots_.view(), listed_.view()});
  if (more.size() > 0)
    for_each("implicit.couplings", more.size(), Append{more, count, list_.view(), slots_.view()});
  corners_.build(list_.view(), slots_.view(), vertices);
}

}  // namespace icloth::ICLOTH_BUILD
