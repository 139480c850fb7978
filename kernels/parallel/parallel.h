// The primitives: the only place where the stages meet a backend (oneTBB or CUDA).
//
// Each takes a readable name first, which becomes a row of the profile
// (kernels/parallel/profile.h). Results do not depend on the number of threads, and equal input
// gives equal bits on one device. Functors are copied to the device by value; they hold views and
// numbers, and are small. Primitives are called from one host thread at a time a simulator, never
// from inside a kernel.
#pragma once

#include <cstdint>

#include "kernels/parallel/array.h"
#include "kernels/parallel/platform.h"
#include "kernels/parallel/profile.h"
#include "kernels/parallel/team.h"

namespace icloth::ICLOTH_BUILD {

/// The sum of two values.
struct Sum {
  template <class T>
  ICLOTH_HD T operator()(T a, T b) const {
    return static_cast<T>(a + b);
  }
};
/// The larger of two values; a NaN on either side wins, so that it cannot hide.
struct Max {
  template <class T>
  ICLOTH_HD T operator()(T a, T b) const {
    return (a > b || a != a) ? a : b;
  }
};
/// The smaller of two values; a NaN on either side wins.
struct Min {
  template <class T>
  ICLOTH_HD T operator()(T a, T b) const {
    return (a < b || a != a) ? a : b;
  }
};

/// Calls f(i) for i = 0 … n − 1 in any order; calls must not touch each other's outputs.
template <class F>
void for_each(const char* name, Index n, const F& f);

/// Combines f(0) … f(n − 1) by `op` in an order fixed by n alone and returns the result on the
/// host; `identity` when n is 0. `op` must be commutative and associative but for rounding, and
/// op(identity, a) = a. f is called once for each i and may also write its own outputs.
/// T is trivially copyable, at most 64 bytes.
template <class T, class F, class Op>
T reduce(const char* name, Index n, T identity, const F& f, const Op& op);

/// offsets[i] = counts[0] + … + counts[i − 1]; returns the total. Counts are not negative. Both
/// views may be the same memory. `offsets` has the length of `counts`, or one more: its last
/// entry then gets the total. Throws std::length_error when the total exceeds 2³¹ − 1.
Index exclusive_scan(const char* name, View<const Index> counts, View<Index> offsets);

/// Sorts by the low `key_bits` bits of the keys, ascending and stable; values move with their keys.
void sort_by_key(const char* name, View<std::uint64_t> keys, View<Index> values, int key_bits = 64);

/// Sets `out` to the indices i < n with keep(i), ascending; returns how many. `keep` is pure: it
/// may be called more than once for an index.
template <class P>
Index compact(const char* name, Index n, const P& keep, Array<Index>& out);

/// Output of unknown length: f(i, emit) calls emit(T) any number of times; `out` gets all of it,
/// ordered by i, then by emission. Returns the length; throws std::length_error beyond 2³¹ − 1.
/// f's operator() is a template on the emitter and must emit the same when called again.
template <class T, class F>
Index collect(const char* name, Index n, const F& f, Array<T>& out);

/// Calls f(team, t) for t = 0 … teams − 1: a team is one task on the CPU, a thread block on CUDA.
/// f runs on every thread of the team, which share work by the members of Team
/// (kernels/parallel/team.h).
template <class F>
void for_each_team(const char* name, Index teams, const F& f);

/// Calls f(team) once with a DeviceTeam: every thread of the device works on one problem, in one
/// kernel on CUDA. `n`: the largest number of elements that f will give to the team's members.
/// They are those of Team (kernels/parallel/team.h), and each is a barrier for the whole device;
/// sums have an order that depends on their length alone, but differs between CPU and CUDA. One
/// more member, in_one_block(body), calls body(block) where `block` has for_each alone: on CUDA one
/// block goes through a few small loops, in which it waits for its own threads only.
template <class F>
void with_device_team(const char* name, Index n, const F& f);

}  // namespace icloth::ICLOTH_BUILD

#if defined(__CUDACC__)
#include "kernels/parallel/parallel_cuda.h"
#else
#include "kernels/parallel/parallel_cpu.h"
#endif
