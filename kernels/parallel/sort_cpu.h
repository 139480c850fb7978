// `sort_by_key` on the CPU: radix sort from the lowest digit, each digit counted and scattered by
// chunks. Stable, so the result is unique and cannot depend on how the work is divided.
#pragma once

#include <bit>

namespace icloth::ICLOTH_BUILD {
namespace detail {

inline constexpr int kDigitBits = 8;
inline constexpr Index kDigits = Index{1} << kDigitBits;
inline constexpr Index kComparisonSortBelow = 1024;
inline constexpr Index kSortChunk = 32768;

struct SortItem {
  std::uint64_t key;
  std::uint64_t full_key;  // with the bits that do not count
  Index value;
  Index place;  // before sorting: makes an ordinary sort stable
};

/// Sorts a short list by comparison, on the calling thread.
inline void sort_few(View<std::uint64_t> keys, View<Index> values, std::uint64_t mask) {
  const Index n = keys.size();
  const View<SortItem> items = scratch<SortItem, 5>(n);
  for (Index i = 0; i < n; ++i) items[i] = {keys[i] & mask, keys[i], values[i], i};
  std::sort(items.data(), items.data() + n, [](const SortItem& a, const SortItem& b) {
    return a.key < b.key || (a.key == b.key && a.place < b.place);
  });
  for (Index i = 0; i < n; ++i) {
    keys[i] = items[i].full_key;
    values[i] = items[i].value;
  }
}

/// The bits in which at least two keys differ.
inline std::uint64_t varying_bits(View<const std::uint64_t> keys) {
  const Index n = keys.size();
  const View<std::uint64_t> partial = scratch<std::uint64_t, 6>(chunk_count(n, kSortChunk));
  over_chunks(n, kSortChunk, [&](Index c, Index first, Index last) {
    std::uint64_t varying = 0;
    for (Index i = first; i < last; ++i) varying |= keys[i] ^ keys[0];
    partial[c] = varying;
  });
  std::uint64_t varying = 0;
  for (Index c = 0; c < partial.size(); ++c) varying |= partial[c];
  return varying;
}

/// One pass over all keys and values, which orders them by the digit at `shift`.
class DigitPass {
 public:
  DigitPass(Index n, std::uint64_t mask) : n_(n), mask_(mask), chunks_(chunk_count(n, kSortChunk)) {
    offsets_ = scratch<Index, 7>(chunks_ * kDigits);
  }

  void run(View<const std::uint64_t> keys, View<const Index> values, View<std::uint64_t> keys_out,
           View<Index> values_out, int shift) const {
    count(keys, shift);
    scan();
    over_chunks(n_, kSortChunk, [&](Index c, Index first, Index last) {
      Index* const offset = offsets_.data() + c * kDigits;
      for (Index i = first; i < last; ++i) {
        const Index to = offset[digit(keys[i], shift)]++;
        keys_out[to] = keys[i];
        values_out[to] = values[i];
      }
    });
  }

 private:
  std::size_t digit(std::uint64_t key, int shift) const {
    return static_cast<std::size_t>((key & mask_) >> shift) & (kDigits - 1);
  }
  void count(View<const std::uint64_t> keys, int shift) const {
    over_chunks(n_, kSortChunk, [&](Index c, Index first, Index last) {
      Index* const counts = offsets_.data() + c * kDigits;
      std::fill_n(counts, kDigits, 0);
      for (Index i = first; i < last; ++i) ++counts[digit(keys[i], shift)];
    });
  }
  /// Turns counts into first places: smaller digits come first, and earlier chunks within a digit.
  void scan() const {
    Index sum = 0;
    for (Index d = 0; d < kDigits; ++d) {
      for (Index c = 0; c < chunks_; ++c) sum += std::exchange(offsets_[c * kDigits + d], sum);
    }
  }

  Index n_;
  std::uint64_t mask_;  // the bits that count
  Index chunks_;
  View<Index> offsets_;  // (chunks × digits)
};

}  // namespace detail

inline void sort_by_key(const char* name, View<std::uint64_t> keys, View<Index> values,
                        int key_bits) {
  const ProfileScope scope(name);
  const Index n = keys.size();
  assert(values.size() == n && key_bits >= 0 && key_bits <= 64);
  const std::uint64_t mask =
      key_bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << key_bits) - 1;
  if (n < detail::kComparisonSortBelow) return detail::sort_few(keys, values, mask);

  // The passes go to and fro between the caller's memory and scratch memory. A digit in which no
  // two keys differ needs no pass.
  View<std::uint64_t> from_keys = keys, to_keys = detail::scratch<std::uint64_t, 8>(n);
  View<Index> from_values = values, to_values = detail::scratch<Index, 9>(n);
  const detail::DigitPass pass(n, mask);

  std::uint64_t left = detail::varying_bits(keys) & mask;  // equal digits need no pass
  while (left != 0) {
    const int shift = std::countr_zero(left);
    pass.run(from_keys, from_values, to_keys, to_values, shift);
    std::swap(from_keys, to_keys);
    std::swap(from_values, to_values);
    left = shift + detail::kDigitBits >= 64
               ? 0
               : left >> (shift + detail::kDigitBits) << (shift + detail::kDigitBits);
  }

  // An odd number of passes ended in the scratch memory.
  if (from_keys.data() != keys.data()) {
    memory::copy(keys.data(), from_keys.data(),
                 static_cast<std::size_t>(n) * sizeof(std::uint64_t));
    memory::copy(values.data(), from_values.data(), static_cast<std::size_t>(n) * sizeof(Index));
  }
}

}  // namespace icloth::ICLOTH_BUILD
