// The primitives on a CUDA device. Included by kernels/parallel/parallel.h, which says what they
// do.
//
// Everything runs in order on the default stream; only results for the host are waited for. How
// the work is divided depends on n alone, never on the device, so that sums keep their bits.
#pragma once

#include <thrust/iterator/counting_iterator.h>

#include <cstring>
#include <cub/cub.cuh>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "kernels/parallel/cuda_check.h"
#include "kernels/parallel/launch.h"

namespace icloth::ICLOTH_BUILD {
namespace detail {

inline constexpr int kThreads = 256;  // of a block
/// Elements of collect walk trees or test pairs: much work each, and few of them in small scenes.
/// Small blocks spread those over the whole device.
inline constexpr int kCollectThreads = 64;

inline unsigned block_count(Index n, Index per_block) {
  return (static_cast<unsigned>(n) + static_cast<unsigned>(per_block) - 1) /
         static_cast<unsigned>(per_block);
}

inline void wait_for_device() { static_cast<void>(cudaDeviceSynchronize()); }

/// Measures a primitive together with the device work that it started.
class CudaScope : public ProfileScope {
 public:
  explicit CudaScope(const char* name) : ProfileScope(name, &wait_for_device) {}
};

inline void check_launch(const char* name) { ICLOTH_CUDA_CHECK(name, cudaGetLastError()); }

/// Memory that a primitive keeps between its calls; per thread, as two simulators may run at once.
/// Given up when the thread has moved to another device.
template <class T, int Slot>
View<T> scratch(Index n) {
  thread_local Array<T> array;
  thread_local int owner = -1;
  int device = 0;
  ICLOTH_CUDA_CHECK("scratch", cudaGetDevice(&device));
  if (std::exchange(owner, device) != device) array = Array<T>();
  array.resize(n);
  return array.view();
}

/// Runs a CUB algorithm: asks for the size of its temporary storage, then calls it with that.
template <class Algorithm>
void run_cub(const char* name, const Algorithm& algorithm) {
  std::size_t bytes = 0;
  ICLOTH_CUDA_CHECK(name, algorithm(nullptr, bytes));
  constexpr std::size_t kUnit = 256;
  struct Unit {
    unsigned char bytes[kUnit];
  };
  const auto units = static_cast<Index>(bytes / kUnit + 1);
  ICLOTH_CUDA_CHECK(name, algorithm(scratch<Unit, 0>(units).data(), bytes));
}

[[noreturn]] inline void throw_too_long(const char* name) {
  throw std::length_error(std::string(name) + ": more than 2^31 - 1 elements");
}

template <class F>
__global__ void for_each_kernel(Index n, const F f) {
  const auto i = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < n) f(static_cast<Index>(i));
}

template <class F>
__global__ void __launch_bounds__(Team::kThreads) team_kernel(const F f) {
  Team team;
  f(team, static_cast<Index>(blockIdx.x));
}

/// Combines one value of each thread of the block in a fixed order; every thread gets the result.
template <class T, class Op>
__device__ T combine_in_block(T value, const Op& op) {
  ICLOTH_SHARED(storage, kThreads * sizeof(T));
  T* const shared = reinterpret_cast<T*>(storage);
  const auto me = static_cast<int>(threadIdx.x);
  shared[me] = value;

  // The upper half of the values is folded onto the lower half until one is left.
  for (int half = kThreads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (me < half) shared[me] = op(shared[me], shared[me + half]);
  }
  __syncthreads();
  const T result = shared[0];
  __syncthreads();  // the next call uses the storage again
  return result;
}

/// Elements that a block of a reduction combines: it decides the rounding, so it depends on n
/// alone. One a thread while that makes no more than 1024 blocks.
inline Index reduce_tile(Index n) {
  constexpr Index kMostBlocks = 1024;
  return kThreads * static_cast<Index>(block_count(n, kThreads * kMostBlocks));
}

/// Block b combines f over its tile into partial[b]; the block that ends last combines those.
/// `ticket` is zero before and after.
template <class T, class F, class Op>
__global__ void __launch_bounds__(kThreads)
    reduce_kernel(Index n, Index tile, T identity, const F f, const Op op, T* partial,
                  unsigned* ticket, T* result) {
  const auto me = static_cast<Index>(threadIdx.x);
  const std::int64_t first = static_cast<std::int64_t>(blockIdx.x) * tile;
  const std::int64_t last = first + tile < n ? first + tile : n;
  T value = identity;
  for (std::int64_t i = first + me; i < last; i += kThreads) {
    value = op(value, static_cast<T>(f(static_cast<Index>(i))));
  }
  value = combine_in_block(value, op);
  ICLOTH_SHARED(flag, sizeof(bool));
  bool& is_last = *reinterpret_cast<bool*>(flag);
  if (me == 0) {
    partial[blockIdx.x] = value;
    __threadfence();  // the partial result is seen by whoever sees the ticket
    is_last = atomicInc(ticket, gridDim.x - 1) == gridDim.x - 1;
  }
  __syncthreads();
  if (!is_last) return;
  __threadfence();
  value = identity;
  for (unsigned t = threadIdx.x; t < gridDim.x; t += kThreads) value = op(value, partial[t]);
  value = combine_in_block(value, op);
  if (me == 0) *result = value;
}

/// Pinned host memory in which kernels leave numbers for the host, which only has to wait for the
/// kernel. Each host thread has one.
class Mailbox {
 public:
  static constexpr std::size_t kBytes = 64;

  /// The calling thread's, on its device.
  static Mailbox& mine() {
    thread_local Mailbox mailbox;
    int device = 0;
    ICLOTH_CUDA_CHECK("mailbox", cudaGetDevice(&device));
    if (mailbox.device_ != device) mailbox.move_to(device);
    return mailbox;
  }
  ~Mailbox() { release(); }

  void* on_device() const { return on_device_; }
  /// Counts the blocks of a reduction that have ended.
  unsigned* ticket() const { return ticket_; }

  /// Waits for the kernels and returns what they wrote.
  template <class T>
  T read(const char* name) const {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= kBytes);
    ICLOTH_CUDA_CHECK(name, cudaStreamSynchronize(nullptr));
    alignas(T) unsigned char value[sizeof(T)];
    std::memcpy(value, on_host_, sizeof(T));
    return *reinterpret_cast<T*>(value);
  }

 private:
  Mailbox() = default;
  void move_to(int device) {
    release();
    ICLOTH_CUDA_CHECK("mailbox", cudaHostAlloc(&on_host_, kBytes, cudaHostAllocMapped));
    ICLOTH_CUDA_CHECK("mailbox", cudaHostGetDevicePointer(&on_device_, on_host_, 0));
    ICLOTH_CUDA_CHECK("mailbox", cudaMalloc(&ticket_, sizeof *ticket_));
    ICLOTH_CUDA_CHECK("mailbox", cudaMemset(ticket_, 0, sizeof *ticket_));
    device_ = device;
  }
  /// Unchecked: it runs at program exit too, even after the driver has shut down.
  void release() {
    if (on_host_ != nullptr) static_cast<void>(cudaFreeHost(on_host_));
    if (ticket_ != nullptr) static_cast<void>(cudaFree(ticket_));
    on_host_ = on_device_ = nullptr;
    ticket_ = nullptr;
    device_ = -1;
  }

  int device_ = -1;
  void *on_host_ = nullptr, *on_device_ = nullptr;
  unsigned* ticket_ = nullptr;
};

/// `reduce` without a row in the profile.
template <class T, class F, class Op>
T reduce_on_device(const char* name, Index n, T identity, const F& f, const Op& op) {
  if (n <= 0) return identity;
  const Index tile = reduce_tile(n);
  const unsigned tiles = block_count(n, tile);
  const View<T> partial = scratch<T, 1>(static_cast<Index>(tiles));
  const Mailbox& mailbox = Mailbox::mine();
  ICLOTH_LAUNCH(reduce_kernel, tiles, kThreads)
  (n, tile, identity, f, op, partial.data(), mailbox.ticket(),
   static_cast<T*>(mailbox.on_device()));
  check_launch(name);
  return mailbox.read<T>(name);
}

struct CountAt {
  View<const Index> counts;
  ICLOTH_HD std::int64_t operator()(Index i) const { return counts[i]; }
};

/// `exclusive_scan` without a row in the profile.
inline Index scan_on_device(const char* name, View<const Index> counts, View<Index> offsets) {
  const Index n = counts.size();
  const std::int64_t total = reduce_on_device(name, n, std::int64_t{0}, CountAt{counts}, Sum{});
  if (total > std::numeric_limits<Index>::max()) throw_too_long(name);
  if (n > 0) {
    run_cub(name, [&](void* storage, std::size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(storage, bytes, counts.data(), offsets.data(), n);
    });
  }
  const auto result = static_cast<Index>(total);
  if (offsets.size() > n) memory::copy_from_host(offsets.data() + n, &result, sizeof result);
  return result;
}

/// Counts what is emitted. Copies count in the same place.
template <class T>
struct CountingEmitter {
  Index* count;
  ICLOTH_HD void operator()(const T&) const { ++*count; }
};
/// Writes what is emitted from `next` on.
template <class T>
struct WritingEmitter {
  T** next;
  ICLOTH_HD void operator()(const T& value) const { *(*next)++ = value; }
};

template <class T, class F>
struct CountEmitted {
  F f;
  View<Index> counts;
  __device__ void operator()(Index i) const {
    Index count = 0;
    CountingEmitter<T> emit{&count};
    f(i, emit);
    counts[i] = count;
  }
};
template <class T, class F>
struct WriteEmitted {
  F f;
  View<const Index> offsets;
  View<T> out;
  __device__ void operator()(Index i) const {
    T* next = out.data() + offsets[i];
    WritingEmitter<T> emit{&next};
    f(i, emit);
  }
};

/// `for_each` without a row in the profile.
template <class F>
void launch(const char* name, Index n, const F& f, int threads = kThreads) {
  if (n <= 0) return;
  ICLOTH_LAUNCH(for_each_kernel, block_count(n, threads), static_cast<unsigned>(threads))(n, f);
  check_launch(name);
}

}  // namespace detail

template <class F>
void for_each(const char* name, Index n, const F& f) {
  const detail::CudaScope scope(name);
  detail::launch(name, n, f);
}

template <class T, class F, class Op>
T reduce(const char* name, Index n, T identity, const F& f, const Op& op) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= 64);
  const detail::CudaScope scope(name);
  return detail::reduce_on_device(name, n, identity, f, op);
}

inline Index exclusive_scan(const char* name, View<const Index> counts, View<Index> offsets) {
  const detail::CudaScope scope(name);
  return detail::scan_on_device(name, counts, offsets);
}

inline void sort_by_key(const char* name, View<std::uint64_t> keys, View<Index> values,
                        int key_bits) {
  const detail::CudaScope scope(name);
  const Index n = keys.size();
  assert(values.size() == n && key_bits >= 0 && key_bits <= 64);
  if (n <= 1 || key_bits == 0) return;
  cub::DoubleBuffer<std::uint64_t> both_keys(keys.data(),
                                             detail::scratch<std::uint64_t, 2>(n).data());
  cub::DoubleBuffer<Index> both_values(values.data(), detail::scratch<Index, 3>(n).data());
  detail::run_cub(name, [&](void* storage, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(storage, bytes, both_keys, both_values, n, 0, key_bits);
  });
  const auto count = static_cast<std::size_t>(n);
  if (both_keys.Current() != keys.data()) {
    memory::copy(keys.data(), both_keys.Current(), count * sizeof(std::uint64_t));
  }
  if (both_values.Current() != values.data()) {
    memory::copy(values.data(), both_values.Current(), count * sizeof(Index));
  }
}

template <class P>
Index compact(const char* name, Index n, const P& keep, Array<Index>& out) {
  const detail::CudaScope scope(name);
  if (n <= 0) {
    out.resize(0);
    return 0;
  }
  out.resize(n);

  // The number of indices comes back through memory that the host reads without a copy.
  const detail::Mailbox& mailbox = detail::Mailbox::mine();
  detail::run_cub(name, [&](void* storage, std::size_t& bytes) {
    return cub::DeviceSelect::If(storage, bytes, thrust::counting_iterator<Index>(0),
                                 out.view().data(), static_cast<Index*>(mailbox.on_device()), n,
                                 keep);
  });

  const auto count = mailbox.read<Index>(name);
  out.resize(count);
  return count;
}

template <class T, class F>
Index collect(const char* name, Index n, const F& f, Array<T>& out) {
  const detail::CudaScope scope(name);
  const View<Index> offsets = detail::scratch<Index, 4>(n);
  detail::launch(name, n, detail::CountEmitted<T, F>{f, offsets}, detail::kCollectThreads);
  const Index total = detail::scan_on_device(name, offsets, offsets);
  out.resize(total);
  if (total > 0)
    detail::launch(name, n, detail::WriteEmitted<T, F>{f, offsets, out.view()},
                   detail::kCollectThreads);
  return total;
}

template <class F>
void for_each_team(const char* name, Index teams, const F& f) {
  const detail::CudaScope scope(name);
  if (teams <= 0) return;
  ICLOTH_LAUNCH(detail::team_kernel, static_cast<unsigned>(teams), Team::kThreads,
                Team::kSharedBytes)
  (f);
  detail::check_launch(name);
}

}  // namespace icloth::ICLOTH_BUILD

#include "kernels/parallel/device_team_cuda.h"
