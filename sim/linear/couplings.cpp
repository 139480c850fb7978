#include "sim/linear/couplings.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct IsActive {
  View<const ContactTerm> terms;
  ICLOTH_HD bool operator()(Index i) const { return terms[i].active != 0; }
};

struct Pack {
  View<const Contact> contacts;
  View<const ContactTerm> terms;
  View<const Index> active;
  View<Coupling> list;
  View<Int4> slots;

  ICLOTH_HD void operator()(Index i) const {
    const Stencil& s = contacts[active[i]].s;
    const ContactTerm& t = terms[active[i]];
    list[i] = {s, t.h, t.impulse};
    slots[i] = {{s.v[0], s.v[1], s.v[2], s.v[3]}};
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

}  // namespace

void Couplings::gather(View<const Contact> contacts, View<const ContactTerm> terms, Index vertices,
                       View<const Coupling> more) {
  const Index count = contacts.size() == 0 ? 0
                                           : compact("implicit.active_contacts", contacts.size(),
                                                     IsActive{terms}, active_);
  const Index total = count + more.size();
  list_.resize(total);
  slots_.resize(total);
  if (total == 0) return;
  for_each("implicit.couplings", count,
           Pack{contacts, terms, active_.view(), list_.view(), slots_.view()});
  if (more.size() > 0)
    for_each("implicit.couplings", more.size(), Append{more, count, list_.view(), slots_.view()});
  incidence_.build(slots_.view(), vertices);
}

}  // namespace icloth::ICLOTH_BUILD
