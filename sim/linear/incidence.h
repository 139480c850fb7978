// Lists of the constraints that act on a vertex, shared by proximity and impact zones.
#pragma once

#include "kernels/parallel/parallel.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// Sorted vertex → constraint lists: entries of vertex i are first[i] … first[i+1]−1, each
/// 4·constraint + corner, ascending. Gathering through it needs no atomics and always adds up in
/// the same order.
class Incidence {
 public:
  /// Builds the lists. `slots` holds the vertex number of every corner (constraints), where kNone
  /// or a number ≥ vertices marks corners to leave out.
  void build(View<const Int4> slots, Index vertices);

  View<const Index> first() const { return first_.view(); }     ///< (vertices + 1)
  View<const Index> entries() const { return values_.view(); }  ///< (≤ 4·constraints)

 private:
  Array<Index> first_, values_;
  Array<std::uint64_t> keys_;
};

/// The keys of records, and the order in which they stand.
template <class T>
struct KeysOf {
  View<const T> records;
  View<std::uint64_t> keys;
  View<Index> order;
  ICLOTH_HD void operator()(Index i) const {
    keys[i] = records[i].key;
    order[i] = i;
  }
};

/// Copies records in a given order.
template <class T>
struct Permute {
  View<const T> from;
  View<const Index> order;
  View<T> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[order[i]]; }
};

/// Appends records sorted by their `key`, so that a list depends on the state alone and not on the
/// order in which a tree was walked.
class SortedAppend {
 public:
  template <class T>
  void operator()(const char* name, const Array<T>& found, Array<T>& list) {
    const Index first = list.size(), count = found.size();
    keys_.resize(count);
    order_.resize(count);
    for_each(name, count, KeysOf<T>{found.view(), keys_.view(), order_.view()});
    sort_by_key(name, keys_.view(), order_.view());
    list.resize_keep(first + count);
    for_each(name, count, Permute<T>{found.view(), order_.view(), list.view().sub(first, count)});
  }

 private:
  Array<std::uint64_t> keys_;
  Array<Index> order_;
};

}  // namespace icloth::ICLOTH_BUILD
