#include "sim/linear/coarse_couplings.h"

#include "kernels/parallel/partition_point.h"

namespace icloth::ICLOTH_BUILD {
namespace {

ICLOTH_HD std::uint64_t key_of(Index row, Index column) {
  return (static_cast<std::uint64_t>(row) << 32) | static_cast<std::uint64_t>(column);
}
ICLOTH_HD Index row_of(std::uint64_t key) { return static_cast<Index>(key >> 32); }
ICLOTH_HD Index column_of(std::uint64_t key) { return static_cast<Index>(key & 0xffffffffu); }

/// Lists the pairs of nodes that a coupling acts on, with the product of their weights.
struct FindTerms {
  SomeCouplings couplings;
  View<const Real> inverse_mass;
  View<const Index> group;

  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    const Index c = couplings[i];
    const Stencil& s = couplings.list[c].s;
    Index nodes[4];
    Real weights[4];
    int count = 0;

    // The weights of corners in the same group add up; prescribed vertices and those of obstacles
    // take no part.
    for (int a = 0; a < 4; ++a) {
      const Index v = s.v[a];
      if (v >= group.size() || !(inverse_mass[v] > 0)) continue;
      int k = 0;
      while (k < count && nodes[k] != group[v]) ++k;
      if (k == count) nodes[count] = group[v], weights[count++] = 0;
      weights[k] += s.w[a];
    }

    // Every pair of nodes gets its share of H.
    for (int a = 0; a < count; ++a)
      for (int b = 0; b < count; ++b)
        emit(CoarseTerm{key_of(nodes[a], nodes[b]), c, weights[a] * weights[b]});
  }
};

/// The order of terms: block by block, and by coupling in each.
ICLOTH_HD bool comes_before(const CoarseTerm& a, const CoarseTerm& b) {
  return a.key < b.key || (a.key == b.key && a.coupling < b.coupling);
}

/// Puts the terms that were there before to their places among those that were added, run by run:
/// the place of the first one of a run is searched for, and the others follow from it.
struct PlaceTermsBefore {
  static constexpr Index kRun = 32;
  View<const CoarseTerm> before, added;
  View<const Index> moved;  ///< see CouplingChange
  View<CoarseTerm> merged;

  static Index runs(Index terms) { return (terms + kRun - 1) / kRun; }
  ICLOTH_HD CoarseTerm now(Index i) const {
    CoarseTerm term = before[i];
    term.coupling = moved[term.coupling];
    return term;
  }

  ICLOTH_HD void operator()(Index run) const {
    const Index first = run * kRun, left = before.size() - first;
    Index earlier =
        partition_point(added.size(), [&](Index k) { return comes_before(added[k], now(first)); });
    for (Index i = first; i < first + (left < kRun ? left : kRun); ++i) {
      const CoarseTerm term = now(i);
      while (earlier < added.size() && comes_before(added[earlier], term)) ++earlier;
      merged[i + earlier] = term;
    }
  }
};

/// Puts the added terms to their places among those that were there before.
struct PlaceTermsAdded {
  View<const CoarseTerm> before, added;
  View<const Index> moved;  ///< see CouplingChange
  View<CoarseTerm> merged;

  ICLOTH_HD void operator()(Index k) const {
    const CoarseTerm term = added[k];
    const Index earlier = partition_point(before.size(), [&](Index i) {
      CoarseTerm other = before[i];
      other.coupling = moved[other.coupling];
      return comes_before(other, term);
    });
    merged[k + earlier] = term;
  }
};

struct StartsBlock {
  View<const CoarseTerm> terms;
  ICLOTH_HD bool operator()(Index i) const { return i == 0 || terms[i].key != terms[i - 1].key; }
};

struct BlockColumn {
  View<const CoarseTerm> terms;
  View<const Index> starts;
  View<Index> column;
  ICLOTH_HD void operator()(Index k) const { column[k] = column_of(terms[starts[k]].key); }
};

/// Sums up the terms of one block.
struct SumBlock {
  View<const CoarseTerm> terms;
  View<const Index> starts;
  View<const Coupling> couplings;
  View<Mat3r> value;

  ICLOTH_HD void operator()(Index k) const {
    const Index end = k + 1 < starts.size() ? starts[k + 1] : terms.size();
    Mat3r sum{};
    for (Index t = starts[k]; t < end; ++t)
      sum += couplings[terms[t].coupling].h.scaled(terms[t].weight);
    value[k] = sum;
  }
};

/// Finds the first block of row i.
struct FirstBlocks {
  View<const CoarseTerm> terms;
  View<const Index> starts;
  View<Index> first;

  ICLOTH_HD void operator()(Index i) const {
    first[i] =
        partition_point(starts.size(), [&](Index k) { return row_of(terms[starts[k]].key) < i; });
  }
};

}  // namespace

void CoarseCouplings::fill(const SystemView& system, View<const Index> group, Index nodes) {
  const CouplingView& couplings = system.couplings;
  if (layout_ == 0 || couplings.layout != layout_) lay_out(system, group, nodes);
  layout_ = couplings.layout;
  if (couplings.size() == 0) return;
  for_each("implicit.coarse_sums", starts_.size(),
           SumBlock{terms_.view(), starts_.view(), couplings.list, value_.view()});
}

void CoarseCouplings::lay_out(const SystemView& system, View<const Index> group, Index nodes) {
  const CouplingView& couplings = system.couplings;
  const bool follows = layout_ != 0 && couplings.change.from == layout_ && terms_.size() > 0;
  first_.resize(0);
  column_.resize(0);
  value_.resize(0);
  if (couplings.size() == 0) {
    terms_.resize(0);
    return;
  }
  if (follows)
    merge_terms(system, group);
  else
    sort_terms(system, group);

  // Every first term of a block starts one.
  compact("implicit.coarse_starts", terms_.size(), StartsBlock{terms_.view()}, starts_);
  column_.resize(starts_.size());
  value_.resize(starts_.size() + kPadding);
  for_each("implicit.coarse_columns", starts_.size(),
           BlockColumn{terms_.view(), starts_.view(), column_.view()});

  // The rows of the blocks follow by bisection.
  first_.resize(nodes + 1);
  for_each("implicit.coarse_first", nodes + 1,
           FirstBlocks{terms_.view(), starts_.view(), first_.view()});
}

/// Terms are listed and sorted by their block, so that each block is a sum in a fixed order.
void CoarseCouplings::sort_terms(const SystemView& system, View<const Index> group) {
  const SomeCouplings all{system.couplings.list, {}, true};
  collect("implicit.coarse_terms", all.size(), FindTerms{all, system.inverse_mass, group}, found_);
  terms_.resize(0);
  append_sorted_("implicit.coarse_sort", found_, terms_);
}

/// The same list from the one before: only the terms of the couplings that were added are sorted.
void CoarseCouplings::merge_terms(const SystemView& system, View<const Index> group) {
  const CouplingChange& change = system.couplings.change;
  const SomeCouplings added{system.couplings.list, change.added, false};
  collect("implicit.coarse_terms", added.size(), FindTerms{added, system.inverse_mass, group},
          found_);
  added_.resize(0);
  append_sorted_("implicit.coarse_sort", found_, added_);

  swap(terms_, before_);
  terms_.resize(before_.size() + added_.size());
  for_each("implicit.coarse_merge", PlaceTermsBefore::runs(before_.size()),
           PlaceTermsBefore{before_.view(), added_.view(), change.moved, terms_.view()});
  for_each("implicit.coarse_merge", added_.size(),
           PlaceTermsAdded{before_.view(), added_.view(), change.moved, terms_.view()});
}

}  // namespace icloth::ICLOTH_BUILD
