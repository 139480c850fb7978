#include "sim/linear/incidence.h"

#include "kernels/parallel/partition_point.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// The key of a corner is its vertex; corners that are left out sort behind all vertices.
struct CornerKeys {
  View<const Int4> slots;
  View<std::uint64_t> keys;
  View<Index> values;
  Index vertices;

  ICLOTH_HD void operator()(Index i) const {
    const Index v = slots[i / 4].v[i % 4];
    const bool left_out = v == kNone || v >= vertices;
    keys[i] = static_cast<std::uint64_t>(left_out ? vertices : v);
    values[i] = i;
  }
};

/// Finds the first entry of vertex i in the sorted keys.
struct FirstEntries {
  View<const std::uint64_t> keys;
  View<Index> first;

  ICLOTH_HD void operator()(Index i) const {
    first[i] = partition_point(keys.size(),
                               [&](Index k) { return keys[k] < static_cast<std::uint64_t>(i); });
  }
};

/// Number of bits of the keys that need sorting.
int bits_for(Index largest) {
  int bits = 1;
  while (bits < 31 && (largest >> bits) != 0) ++bits;
  return bits;
}

}  // namespace

void Incidence::build(View<const Int4> slots, Index vertices) {
  const Index corners = 4 * slots.size();
  keys_.resize(corners);
  values_.resize(corners);
  first_.resize(vertices + 1);

  // A stable sort of the corners by their vertex makes the lists, with ascending constraints in
  // each.
  for_each("constraints.corners", corners,
           CornerKeys{slots, keys_.view(), values_.view(), vertices});
  sort_by_key("constraints.sort", keys_.view(), values_.view(), bits_for(vertices));
  for_each("constraints.first", vertices + 1, FirstEntries{keys_.view(), first_.view()});
}

}  // namespace icloth::ICLOTH_BUILD
