// The primitives on the CPU, over oneTBB. This file is included by kernels/parallel/parallel.h,
// which documents them.
//
// Few elements are done by the calling thread alone: passing work to another one costs about a
// microsecond.
#pragma once

#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "kernels/parallel/parallel_for.h"

namespace icloth::ICLOTH_BUILD {
namespace detail {

inline constexpr Index kForEachSerialBelow = 1024;
inline constexpr Index kForEachGrain = 256;
inline constexpr Index kReduceChunk = 1024;  // fixed: it decides the rounding of a sum
inline constexpr Index kScanChunk = 16384;
inline constexpr Index kCompactChunk = 4096;
inline constexpr Index kCollectChunk = 64;  // work of one element is large: it walks a tree or grid

/// Memory that a primitive keeps between its calls. It is per thread, as two simulators may run at
/// once.
template <class T, int Slot>
View<T> scratch(Index n) {
  thread_local Array<T> array;
  array.resize(n);
  return array.view();
}

inline Index chunk_count(Index n, Index chunk) { return n / chunk + (n % chunk != 0 ? 1 : 0); }

/// Calls body(chunk, first, last) for chunks of fixed size.
template <class Body>
void over_chunks(Index n, Index chunk, const Body& body) {
  const Index chunks = chunk_count(n, chunk);
  parallel_for(chunks, 2, 1, [&](Index begin, Index end) {
    for (Index c = begin; c < end; ++c) {
      const Index first = c * chunk;
      body(c, first, first + std::min(chunk, n - first));
    }
  });
}

[[noreturn]] inline void throw_too_long(const char* name) {
  throw std::length_error(std::string(name) + ": more than 2^31 - 1 elements");
}

/// Reduces one chunk. Numbers have four running values, since one alone would wait for the latency
/// of every addition.
template <class T, class F, class Op>
T reduce_chunk(Index first, Index last, T identity, const F& shared_f, const Op& op) {
  const F f = shared_f;  // a local copy lets the compiler keep its members in registers
  Index i = first;
  if constexpr (std::is_arithmetic_v<T>) {
    T lane[4] = {identity, identity, identity, identity};
    for (; last - i >= 4; i += 4) {
      for (Index k = 0; k < 4; ++k) lane[k] = op(lane[k], static_cast<T>(f(i + k)));
    }
    for (; i < last; ++i) lane[0] = op(lane[0], static_cast<T>(f(i)));
    return op(op(lane[0], lane[1]), op(lane[2], lane[3]));
  } else {
    T value = identity;
    for (; i < last; ++i) value = op(value, static_cast<T>(f(i)));
    return value;
  }
}

/// `for_each` without a row in the profile.
template <class F>
void for_each_index(Index n, const F& f) {
  parallel_for(n, kForEachSerialBelow, kForEachGrain, [&f](Index first, Index last) {
    const F local = f;
    for (Index i = first; i < last; ++i) local(i);
  });
}

/// `reduce` without a row in the profile.
template <class T, class F, class Op>
T reduce_indices(Index n, T identity, const F& f, const Op& op) {
  const Index chunks = chunk_count(n, kReduceChunk);
  const View<T> partial = scratch<T, 0>(chunks);
  over_chunks(n, kReduceChunk, [&](Index c, Index first, Index last) {
    partial[c] = reduce_chunk(first, last, identity, f, op);
  });
  T value = identity;
  for (Index c = 0; c < chunks; ++c) value = op(value, partial[c]);
  return value;
}

}  // namespace detail

template <class F>
void for_each(const char* name, Index n, const F& f) {
  const ProfileScope scope(name);
  detail::for_each_index(n, f);
}

template <class T, class F, class Op>
T reduce(const char* name, Index n, T identity, const F& f, const Op& op) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 64);
  const ProfileScope scope(name);
  return detail::reduce_indices(n, identity, f, op);
}

inline Index exclusive_scan(const char* name, View<const Index> counts, View<Index> offsets) {
  const ProfileScope scope(name);

  // Each chunk is summed on its own.
  const Index n = counts.size();
  const View<std::int64_t> start =
      detail::scratch<std::int64_t, 1>(detail::chunk_count(n, detail::kScanChunk));
  detail::over_chunks(n, detail::kScanChunk, [&](Index c, Index first, Index last) {
    std::int64_t sum = 0;
    for (Index i = first; i < last; ++i) sum += counts[i];
    start[c] = sum;
  });

  // The first offset of each chunk follows, in 64 bits so that an overflow is noticed.
  std::int64_t total = 0;
  for (Index c = 0; c < start.size(); ++c) total += std::exchange(start[c], total);
  if (total > std::numeric_limits<Index>::max()) detail::throw_too_long(name);

  // Within a chunk the offsets run on from there.
  detail::over_chunks(n, detail::kScanChunk, [&](Index c, Index first, Index last) {
    Index sum = static_cast<Index>(start[c]);
    for (Index i = first; i < last; ++i) {
      const Index count = counts[i];  // read first: the views may be the same memory
      offsets[i] = sum;
      sum += count;
    }
  });
  if (offsets.size() > n) offsets[n] = static_cast<Index>(total);
  return static_cast<Index>(total);
}

template <class P>
Index compact(const char* name, Index n, const P& keep, Array<Index>& out) {
  const ProfileScope scope(name);

  // Each chunk notes the indices it keeps, packed to the front of its part of the scratch memory.
  const Index chunks = detail::chunk_count(n, detail::kCompactChunk);
  const View<Index> kept = detail::scratch<Index, 2>(n);
  const View<Index> start = detail::scratch<Index, 3>(chunks + 1);
  detail::over_chunks(n, detail::kCompactChunk, [&](Index c, Index first, Index last) {
    const P local = keep;
    Index count = 0;
    for (Index i = first; i < last; ++i) {
      if (local(i)) kept[first + count++] = i;
    }
    start[c] = count;
  });

  // The counts become the places of the chunks in the result.
  Index total = 0;
  for (Index c = 0; c < chunks; ++c) total += std::exchange(start[c], total);
  start[chunks] = total;

  // The packed parts are copied together.
  out.resize(total);
  const View<Index> result = out.view();
  detail::over_chunks(n, detail::kCompactChunk, [&](Index c, Index first, Index) {
    std::copy_n(kept.data() + first, start[c + 1] - start[c], result.data() + start[c]);
  });
  return total;
}

template <class F>
void for_each_team(const char* name, Index teams, const F& f) {
  const ProfileScope scope(name);
  parallel_for(teams, 2, 1, [&f](Index first, Index last) {
    for (Index t = first; t < last; ++t) {
      Team team;
      f(team, t);
    }
  });
}

}  // namespace icloth::ICLOTH_BUILD

#include "kernels/parallel/collect_cpu.h"
#include "kernels/parallel/device_team_cpu.h"
#include "kernels/parallel/sort_cpu.h"
