// exclusive_scan, sort_by_key, compact and collect against plain loops; compiled once a build.
#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "tests/kernels/parallel/primitives_support.h"

namespace icloth::ICLOTH_BUILD {
namespace {

std::vector<Index> small_counts(Index n) {
  std::vector<Index> counts;
  for (Index i = 0; i < n; ++i) {
    counts.push_back(static_cast<Index>(mixed(static_cast<std::uint64_t>(i)) % 5));
  }
  return counts;
}

std::vector<Index> scanned(const std::vector<Index>& counts) {
  std::vector<Index> offsets(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), offsets.begin() + 1);
  return offsets;
}

TEST_F(Primitives, ScanGivesOffsetsAndTotal) {
  for (const Index n : kSizes) {
    const std::vector<Index> expected = scanned(small_counts(n));
    const auto offsets = same_for_all_threads([&] {
      Array<Index> counts, out(n + 1);
      counts.upload(small_counts(n));
      EXPECT_EQ(exclusive_scan("scan", counts.view(), out.view()), expected.back());
      return out.download();
    });
    EXPECT_EQ(offsets, expected) << n;
  }
}

TEST_F(Primitives, ScanWorksInPlace) {
  for (const Index n : kSizes) {
    std::vector<Index> expected = scanned(small_counts(n));
    Array<Index> longer;
    longer.upload(small_counts(n));
    longer.resize_keep(n + 1);
    const View<const Index> counts = longer.view().sub(0, n);
    EXPECT_EQ(exclusive_scan("scan", counts, longer.view()), expected.back());
    EXPECT_EQ(longer.download(), expected) << n;

    Array<Index> same;
    same.upload(small_counts(n));
    EXPECT_EQ(exclusive_scan("scan", same.view(), same.view()), expected.back());
    expected.pop_back();
    EXPECT_EQ(same.download(), expected) << n;
  }
}

TEST_F(Primitives, ScanRefusesTotalsThatDoNotFit) {
  const Index large = std::numeric_limits<Index>::max();
  for (const Index n : {2, 100'000}) {
    Array<Index> counts(n), offsets(n);
    counts.fill(0);
    counts.upload_range(n - 1, std::vector<Index>{large});
    EXPECT_EQ(exclusive_scan("scan", counts.view(), offsets.view()), large);
    counts.upload_range(0, std::vector<Index>{1});
    EXPECT_THROW(exclusive_scan("scan", counts.view(), offsets.view()), std::length_error);
  }
}

struct Pairs {
  std::vector<std::uint64_t> keys;
  std::vector<Index> values;
  bool operator==(const Pairs&) const = default;
};

/// Keys mixed(i) & mask, values 0 … n − 1.
Pairs pairs_to_sort(Index n, std::uint64_t mask) {
  Pairs pairs;
  for (Index i = 0; i < n; ++i) {
    pairs.keys.push_back(mixed(static_cast<std::uint64_t>(i)) & mask);
    pairs.values.push_back(i);
  }
  return pairs;
}

Pairs sorted_by_stable_sort(const Pairs& pairs, std::uint64_t mask) {
  Pairs sorted{{}, pairs.values};
  std::stable_sort(sorted.values.begin(), sorted.values.end(), [&](Index a, Index b) {
    return (pairs.keys[static_cast<std::size_t>(a)] & mask) <
           (pairs.keys[static_cast<std::size_t>(b)] & mask);
  });
  for (const Index v : sorted.values)
    sorted.keys.push_back(pairs.keys[static_cast<std::size_t>(v)]);
  return sorted;
}

Pairs sorted_by_primitive(const Pairs& pairs, int key_bits) {
  return same_for_all_threads([&] {
    Array<std::uint64_t> keys;
    Array<Index> values;
    keys.upload(pairs.keys);
    values.upload(pairs.values);
    sort_by_key("sort", keys.view(), values.view(), key_bits);
    return Pairs{keys.download(), values.download()};
  });
}

TEST_F(Primitives, SortIsAscendingAndStable) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  // All bits; few distinct keys, where stability shows; bits far apart; all keys equal.
  for (const std::uint64_t mask :
       {kAll, std::uint64_t{7}, std::uint64_t{0x8000'0000'0010'0001}, std::uint64_t{0}}) {
    for (const Index n : kSizes) {
      const Pairs pairs = pairs_to_sort(n, mask);
      EXPECT_EQ(sorted_by_primitive(pairs, 64), sorted_by_stable_sort(pairs, kAll)) << n;
    }
  }
}

TEST_F(Primitives, SortCountsOnlyTheLowBits) {
  for (const int bits : {1, 20, 63}) {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    for (const Index n : {33, 1025, 200'000}) {
      const Pairs pairs = pairs_to_sort(n, ~std::uint64_t{0});
      EXPECT_EQ(sorted_by_primitive(pairs, bits), sorted_by_stable_sort(pairs, mask)) << bits;
    }
  }
}

struct EveryNth {
  std::uint64_t n;
  ICLOTH_HD bool operator()(Index i) const {
    return n != 0 && mixed(static_cast<std::uint64_t>(i)) % n == 0;
  }
};

TEST_F(Primitives, CompactKeepsAscendingIndices) {
  for (const std::uint64_t nth : {0u, 1u, 2u, 100u}) {  // none, all, half, few
    for (const Index n : kSizes) {
      std::vector<Index> expected;
      for (Index i = 0; i < n; ++i) {
        if (EveryNth{nth}(i)) expected.push_back(i);
      }
      const auto kept = same_for_all_threads([&] {
        Array<Index> out(3);
        const Index count = compact("compact", n, EveryNth{nth}, out);
        EXPECT_EQ(count, out.size());
        return out.download();
      });
      EXPECT_EQ(kept, expected) << n;
    }
  }
}

struct Emitted {
  Index i, k;
  bool operator==(const Emitted&) const = default;
};

/// Most elements emit nothing or little, every 999th emits 700 times.
struct EmitSome {
  ICLOTH_HD static Index count(Index i) {
    return i % 999 == 7 ? 700 : static_cast<Index>(mixed(static_cast<std::uint64_t>(i)) % 3);
  }
  template <class Emit>
  ICLOTH_HD void operator()(Index i, Emit& emit) const {
    for (Index k = 0; k < count(i); ++k) emit(Emitted{i, k});
  }
};
struct EmitNothing {
  template <class Emit>
  ICLOTH_HD void operator()(Index, Emit&) const {}
};

TEST_F(Primitives, CollectOrdersByElementThenEmission) {
  for (const Index n : kSizes) {
    std::vector<Emitted> expected;
    for (Index i = 0; i < n; ++i) {
      for (Index k = 0; k < EmitSome::count(i); ++k) expected.push_back({i, k});
    }
    const auto found = same_for_all_threads([&] {
      Array<Emitted> out(5);
      EXPECT_EQ(collect("collect", n, EmitSome{}, out), static_cast<Index>(expected.size()));
      return out.download();
    });
    EXPECT_TRUE(found == expected) << n;
  }
}

TEST_F(Primitives, CollectOfNothingIsEmpty) {
  for (const Index n : {0, 1, 5000}) {
    Array<Emitted> out(5);
    EXPECT_EQ(collect("nothing", n, EmitNothing{}, out), 0);
    EXPECT_EQ(out.size(), 0);
  }
}

/// Kept memory of one call must not show in the next, whatever the sizes.
TEST_F(Primitives, CallsOfAlternatingSizesDoNotDisturbEachOther) {
  for (const Index n : {50'000, 10, 0, 200'000, 1000}) {
    const Pairs pairs = pairs_to_sort(n, 0xffff);
    EXPECT_EQ(sorted_by_primitive(pairs, 16), sorted_by_stable_sort(pairs, 0xffff));
    Array<Index> kept;
    Index expected = 0;
    for (Index i = 0; i < n; ++i) expected += EveryNth{3}(i) ? 1 : 0;
    EXPECT_EQ(compact("compact", n, EveryNth{3}, kept), expected);
  }
}

}  // namespace
}  // namespace icloth::ICLOTH_BUILD
