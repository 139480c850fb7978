// A team: the threads of a CUDA block that work on one problem together; one thread on the CPU.
//
// Every member is called by all threads of the team alike (no call inside a branch that only some
// threads take), except within `single`. Plain locals are private to each thread and must be
// computed alike; what the threads share lies in arrays.
#pragma once

#include <type_traits>

#include "kernels/parallel/array.h"
#include "kernels/parallel/platform.h"

#if defined(__CUDACC__)
#include "kernels/parallel/launch.h"
#endif

namespace icloth::ICLOTH_BUILD {

class Team {
 public:
  static constexpr Index kThreads = 128;      ///< of a team on CUDA
  static constexpr int kMaxReduceBytes = 64;  ///< largest sizeof(T) of a reduction

  /// Threads of this team.
  ICLOTH_HD Index size() const {
#if defined(__CUDA_ARCH__)
    return kThreads;
#else
    return 1;
#endif
  }
  /// This thread's number in the team, 0 … size() − 1.
  ICLOTH_HD Index rank() const {
#if defined(__CUDA_ARCH__)
    return static_cast<Index>(threadIdx.x);
#else
    return 0;
#endif
  }
  /// Waits for the whole team; what was written before can be read after.
  ICLOTH_HD void barrier() const {
#if defined(__CUDA_ARCH__)
    __syncthreads();
#endif
  }

  /// body(i) for i = 0 … n − 1 shared among the threads, then a barrier.
  template <class Body>
  ICLOTH_HD void for_each(Index n, const Body& body) const {
    for (std::int64_t i = rank(); i < n; i += size()) body(static_cast<Index>(i));
    barrier();
  }

  /// body() on one thread, then a barrier.
  template <class Body>
  ICLOTH_HD void single(const Body& body) const {
    if (rank() == 0) body();
    barrier();
  }

  /// Combines body(0) … body(n − 1) by `op` in a fixed order; every thread gets the result.
  /// The order differs between CPU and CUDA. Implies barriers.
  template <class T, class Body, class Op>
  ICLOTH_HD T reduce(Index n, T identity, const Body& body, const Op& op) const {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= kMaxReduceBytes);
    T value = identity;
    for (std::int64_t i = rank(); i < n; i += size()) {
      value = op(value, static_cast<T>(body(static_cast<Index>(i))));
    }
    return combine(value, op);
  }

  /// Copy of `view` that all threads reach fast: shared memory on CUDA while there is room, else
  /// the view itself. What is written into it must be given back. Implies a barrier.
  template <class T>
  ICLOTH_HD View<T> borrow(View<T> view) {
#if defined(__CUDA_ARCH__)
    ICLOTH_SHARED_OF_LAUNCH(shared_memory);
    const std::size_t bytes = (static_cast<std::size_t>(view.size()) * sizeof(T) + 15) / 16 * 16;
    if (bytes > kSharedBytes - borrowed_) return view;
    auto* const copy = reinterpret_cast<std::remove_const_t<T>*>(shared_memory + borrowed_);
    borrowed_ += bytes;
    for_each(view.size(), [&](Index i) { copy[i] = view[i]; });
    return {copy, view.size()};
#else
    return view;
#endif
  }
  /// Writes a borrowed copy back to where it came from. Implies a barrier.
  template <class T>
  ICLOTH_HD void give_back(View<const T> copy, View<T> view) const {
    if (copy.data() == view.data()) return;
    for_each(view.size(), [&](Index i) { view[i] = copy[i]; });
  }

  static constexpr std::size_t kSharedBytes = 32 * 1024;  ///< to borrow, of a team on CUDA

 private:
  std::size_t borrowed_ = 0;

#if defined(__CUDA_ARCH__)
  /// Shared memory through which the threads pass values in `combine`. One array serves all types:
  /// with one for each type, a solver that reduces several of them would leave no room to borrow.
  __device__ static unsigned char* reduce_storage() {
    ICLOTH_SHARED(storage, kThreads * kMaxReduceBytes);
    return storage;
  }

  template <class T, class Op>
  __device__ static T combine(T value, const Op& op) {
    static_assert(alignof(T) <= 16);
    T* shared = reinterpret_cast<T*>(reduce_storage());
    const int me = static_cast<int>(threadIdx.x);
    shared[me] = value;

    // The upper half of the values is folded onto the lower half until one is left.
    for (int half = kThreads / 2; half > 0; half /= 2) {
      __syncthreads();
      if (me < half) shared[me] = op(shared[me], shared[me + half]);
    }
    __syncthreads();
    const T result = shared[0];
    __syncthreads();  // the next reduction reuses the storage
    return result;
  }
#else
  template <class T, class Op>
  ICLOTH_HD static T combine(T value, const Op&) {
    return value;
  }
#endif
};

}  // namespace icloth::ICLOTH_BUILD
