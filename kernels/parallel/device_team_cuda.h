// A team of all threads of a CUDA device. Included by kernels/parallel/parallel_cuda.h; what it
// offers is said in kernels/parallel/parallel.h.
#pragma once

#include <cooperative_groups.h>

#include <algorithm>

namespace icloth::ICLOTH_BUILD {

/// The threads of one block of a DeviceTeam.
class BlockOfDevice {
 public:
  template <class Body>
  __device__ void for_each(Index n, const Body& body) const {
    for (std::int64_t i = threadIdx.x; i < n; i += detail::kThreads) body(static_cast<Index>(i));
    __syncthreads();
  }
};

class DeviceTeam {
 public:
  /// `partial`: two buffers of `half` bytes for what the blocks find, used in turn.
  __device__ DeviceTeam(unsigned char* partial, std::size_t half)
      : partial_(partial), half_(half) {}

  __device__ void barrier() const { cooperative_groups::this_grid().sync(); }

  template <class Body>
  __device__ void for_each(Index n, const Body& body) const {
    const std::int64_t all = static_cast<std::int64_t>(gridDim.x) * detail::kThreads;
    for (std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * detail::kThreads + threadIdx.x;
         i < n; i += all) {
      body(static_cast<Index>(i));
    }
    barrier();
  }

  template <class Body>
  __device__ void single(const Body& body) const {
    if (blockIdx.x == 0 && threadIdx.x == 0) body();
    barrier();
  }
  template <class Body>
  __device__ void in_one_block(const Body& body) const {
    if (blockIdx.x == 0) body(BlockOfDevice{});
    barrier();
  }

  /// Tiles have a fixed size, so that the order depends on n alone. Every block combines the
  /// tiles' results for itself: that costs one barrier, and handing out the sum would cost two.
  /// The buffer of the call before may still be read while this call fills the other.
  template <class T, class Body, class Op>
  __device__ T reduce(Index n, T identity, const Body& body, const Op& op) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= kMaxReduceBytes);
    constexpr Index kTile = detail::kThreads;
    const auto me = static_cast<Index>(threadIdx.x);
    const auto tiles = static_cast<unsigned>((static_cast<std::int64_t>(n) + kTile - 1) / kTile);
    T* const found = reinterpret_cast<T*>(partial_ + half_ * turn_);
    turn_ ^= 1u;

    // A tile has the same result whichever block combines it.
    for (unsigned tile = blockIdx.x; tile < tiles; tile += gridDim.x) {
      const std::int64_t i = static_cast<std::int64_t>(tile) * kTile + me;
      T value = i < n ? op(identity, static_cast<T>(body(static_cast<Index>(i)))) : identity;
      value = detail::combine_in_block(value, op);
      if (me == 0) found[tile] = value;
    }

    // All blocks combine the tiles' results in the same order, so that they agree in every bit.
    barrier();
    T value = identity;
    for (unsigned t = threadIdx.x; t < tiles; t += kTile) value = op(value, found[t]);
    return detail::combine_in_block(value, op);
  }

  template <class T>
  __device__ View<T> borrow(View<T> view) const {
    return view;
  }
  template <class T>
  __device__ void give_back(View<const T>, View<T>) const {}

  static constexpr int kMaxReduceBytes = 64;  ///< largest sizeof(T) of a reduction

 private:
  unsigned char* partial_;
  std::size_t half_;
  unsigned turn_ = 0;
};

namespace detail {

template <class F>
__global__ void __launch_bounds__(kThreads)
    device_team_kernel(const F f, unsigned char* partial, std::size_t half) {
  DeviceTeam team(partial, half);
  f(team);
}

/// Blocks of this kernel that the device runs at once: more could not wait for each other.
template <class F>
unsigned resident_blocks(const char* name) {
  int device = 0, processors = 0, per_processor = 0;
  ICLOTH_CUDA_CHECK(name, cudaGetDevice(&device));
  ICLOTH_CUDA_CHECK(name,
                    cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device));
  ICLOTH_CUDA_CHECK(name, cudaOccupancyMaxActiveBlocksPerMultiprocessor(
                              &per_processor, device_team_kernel<F>, kThreads, 0));
  return static_cast<unsigned>(processors) * static_cast<unsigned>(per_processor);
}

}  // namespace detail

template <class F>
void with_device_team(const char* name, Index n, const F& f) {
  const detail::CudaScope scope(name);
  const unsigned tiles = std::max(1u, detail::block_count(n, detail::kThreads));

  // Two buffers take turns, since one may still be read while the next results are written.
  std::size_t half = std::size_t{tiles} * DeviceTeam::kMaxReduceBytes;
  struct Line {
    unsigned char bytes[DeviceTeam::kMaxReduceBytes];
  };
  void* partial = detail::scratch<Line, 5>(static_cast<Index>(2 * tiles)).data();
  F copy = f;
  void* arguments[] = {&copy, &partial, &half};

  // More blocks than the device holds at once would wait for each other without end.
  const unsigned blocks = std::min(tiles, detail::resident_blocks<F>(name));

  // CUDA 12 does not take the name of a template in the call.
  void (*const kernel)(F, unsigned char*, std::size_t) = detail::device_team_kernel<F>;
  ICLOTH_CUDA_CHECK(name, cudaLaunchCooperativeKernel(kernel, dim3(blocks), dim3(detail::kThreads),
                                                      arguments, 0, nullptr));
  detail::check_launch(name);
}

}  // namespace icloth::ICLOTH_BUILD
