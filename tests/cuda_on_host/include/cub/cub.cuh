// Stands in for CUB: scan, radix sort and selection over the whole device, written down serially.
// Each does what CUB leaves open in another way than one may hope: temporary storage is overwritten,
// results lie in either buffer, and predicates are called twice and in any order.
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include "cuda_runtime.h"
#include "tests/cuda_on_host/library.h"

namespace cub {

using ::cuda_on_host::TemporaryStorage;

template <class T>
struct DoubleBuffer {
  T* d_buffers[2];
  int selector = 0;
  DoubleBuffer(T* current, T* alternate) : d_buffers{current, alternate} {}
  T* Current() const { return d_buffers[selector]; }
  T* Alternate() const { return d_buffers[selector ^ 1]; }
};

struct DeviceScan {
  template <class In, class Out>
  static cudaError_t ExclusiveSum(void* storage, std::size_t& bytes, In in, Out out, int n,
                                  cudaStream_t stream = nullptr) {
    const TemporaryStorage temporary(storage, bytes);
    if (temporary.asked) return cudaSuccess;
    ::cuda_on_host::library_call(stream, "cub scan", [=] {
      temporary.overwrite();
      std::remove_reference_t<decltype(out[0])> sum = 0;
      for (int i = 0; i < n; ++i) {
        const auto value = in[i];  // `in` and `out` may be the same
        out[i] = sum;
        sum += value;
      }
    });
    return cudaSuccess;
  }
};

struct DeviceRadixSort {
  template <class Key, class Value>
  static cudaError_t SortPairs(void* storage, std::size_t& bytes, DoubleBuffer<Key>& keys,
                               DoubleBuffer<Value>& values, int n, int begin_bit, int end_bit,
                               cudaStream_t stream = nullptr) {
    const TemporaryStorage temporary(storage, bytes);
    if (temporary.asked) return cudaSuccess;

    // Which buffers the sorted lists end in is CUB's choice: here a random one.
    const DoubleBuffer<Key> given_keys = keys;
    const DoubleBuffer<Value> given_values = values;
    keys.selector ^= ::cuda_on_host::toss();
    values.selector ^= ::cuda_on_host::toss();
    ::cuda_on_host::library_call(stream, "cub sort", [=] {
      temporary.overwrite();
      sort(given_keys, given_values, keys, values, n, begin_bit, end_bit);
    });
    return cudaSuccess;
  }

 private:
  template <class Key, class Value>
  static void sort(const DoubleBuffer<Key>& given_keys, const DoubleBuffer<Value>& given_values,
                   const DoubleBuffer<Key>& keys, const DoubleBuffer<Value>& values, int n,
                   int begin_bit, int end_bit) {
    std::vector<std::pair<Key, Value>> pairs;
    for (int i = 0; i < n; ++i)
      pairs.emplace_back(given_keys.Current()[i], given_values.Current()[i]);
    const int bits = end_bit - begin_bit;
    const Key mask = bits >= 64 ? ~Key{0} : ((Key{1} << bits) - 1) << begin_bit;
    std::stable_sort(pairs.begin(), pairs.end(), [mask](const auto& a, const auto& b) {
      return (a.first & mask) < (b.first & mask);
    });
    int i = 0;
    for (const auto& [key, value] : pairs) {
      keys.Current()[i] = key;
      values.Current()[i] = value;
      ++i;
    }
    // The other buffer holds nothing that anybody may use.
    const auto count = static_cast<std::size_t>(n);
    ::cuda_on_host::poison(keys.Alternate(), count * sizeof(Key));
    ::cuda_on_host::poison(values.Alternate(), count * sizeof(Value));
  }
};

struct DeviceSelect {
  template <class In, class Out, class Count, class Keep>
  static cudaError_t If(void* storage, std::size_t& bytes, In in, Out out, Count count, int n,
                        Keep keep, cudaStream_t stream = nullptr) {
    const TemporaryStorage temporary(storage, bytes);
    if (temporary.asked) return cudaSuccess;
    ::cuda_on_host::check_argument("cub select", keep);
    ::cuda_on_host::library_call(stream, "cub select", [=] {
      temporary.overwrite();
      const auto calls = [&] {
        return ::cuda_on_host::in_any_order(n, [&](int i) { return keep(in[i]); });
      };
      const std::vector<bool> kept = calls();
      if (calls() != kept) ::cuda_on_host::complain("the predicate is not pure");
      int selected = 0;
      for (int i = 0; i < n; ++i)
        if (kept[static_cast<std::size_t>(i)]) out[selected++] = in[i];
      *count = selected;
    });
    return cudaSuccess;
  }
};

}  // namespace cub
