// Kernels and calls with one planted fault each: the emulated device must find every one, and must
// find nothing in the correct ones beside them.
#include <cooperative_groups.h>
#include <gtest/gtest.h>
#include <thrust/iterator/counting_iterator.h>

#include <array>
#include <cstdlib>
#include <cub/cub.cuh>
#include <functional>

#include "kernels/parallel/launch.h"
#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/race_detector.h"
#include "tests/cuda_on_host/device/settings.h"

namespace cuda_on_host {
namespace {

using ::testing::ExitedWithCode;

constexpr int kThreads = 64, kBlocks = 4, kNumbers = kThreads * kBlocks;
using Sums = std::array<int, kBlocks>;

// ---- kernels ------------------------------------------------------------------------------------

/// Sum of the numbers of each block, by halving. The fault: the barrier comes after the addition.
__global__ void sum_of_block(const int* numbers, int* sums, bool late_barrier) {
  ICLOTH_SHARED(bytes, kThreads * sizeof(int));
  int* const shared = reinterpret_cast<int*>(bytes);
  const unsigned me = threadIdx.x;
  shared[me] = numbers[blockIdx.x * kThreads + me];
  for (unsigned half = kThreads / 2; half > 0; half /= 2) {
    if (!late_barrier) __syncthreads();
    if (me < half) shared[me] += shared[me + half];
    if (late_barrier) __syncthreads();
  }
  if (me == 0) sums[blockIdx.x] = shared[0];
}

/// Every block reads what its neighbour wrote. The fault: it does not wait for it.
__global__ void read_neighbour(int* written, int* read, bool late_barrier) {
  const auto grid = cooperative_groups::this_grid();
  if (threadIdx.x == 0) written[blockIdx.x] = static_cast<int>(blockIdx.x) + 1;
  if (!late_barrier) grid.sync();
  if (threadIdx.x == 0) read[blockIdx.x] = written[(blockIdx.x + 1) % gridDim.x];
  if (late_barrier) grid.sync();
}

__global__ void write_at(int* numbers, long at) {
  if (threadIdx.x == 0) numbers[at] = 1;
}
__global__ void copy_from(const int* numbers, long at, int* out) {
  if (threadIdx.x == 0) *out = numbers[at];
}
__global__ void write_behind_shared(int* out) {
  ICLOTH_SHARED(bytes, 16);
  if (threadIdx.x == 0) bytes[16] = 0;
  out[threadIdx.x] = bytes[0];
}
__global__ void write_behind_shared_of_launch(int* out, unsigned bytes) {
  ICLOTH_SHARED_OF_LAUNCH(memory);
  if (threadIdx.x == 0) memory[bytes] = 0;
  out[threadIdx.x] = 1;
}
__global__ void take_two_kinds_of_shared(int* out) {
  ICLOTH_SHARED(bytes, 20 << 10);
  bytes[threadIdx.x] = 1;
  out[threadIdx.x] = bytes[threadIdx.x];
}
__global__ void wait_at_different_barriers(int* out) {
  if (threadIdx.x < 7)
    __syncthreads();
  else
    __syncthreads();
  out[threadIdx.x] = 1;
}
__global__ void leave_before_barrier(int* out) {
  if (threadIdx.x == 5) return;
  __syncthreads();
  out[threadIdx.x] = 1;
}
__global__ void leave_before_grid_barrier(int* out) {
  if (blockIdx.x == 1) return;
  cooperative_groups::this_grid().sync();
  out[blockIdx.x] = 1;
}

// ---- what the tests share -----------------------------------------------------------------------

/// Restores the settings, and gives each test numbers and room for results on the device.
class Faults : public ::testing::Test {
 protected:
  Faults() {
    for (int i = 0; i < kNumbers; ++i) host_[static_cast<std::size_t>(i)] = i * i;
    cudaMalloc(&numbers_, sizeof host_);
    cudaMalloc(&out_, sizeof host_);
    cudaMemcpy(numbers_, host_.data(), sizeof host_, cudaMemcpyHostToDevice);
  }
  ~Faults() override {
    settings() = before_;
    cudaFree(numbers_);
    cudaFree(out_);
  }

  Sums sums(bool late_barrier, const int* numbers) {
    ICLOTH_LAUNCH(sum_of_block, kBlocks, kThreads)(numbers, out_, late_barrier);
    return results();
  }
  Sums neighbours(bool late_barrier) {
    cudaMemset(numbers_, 0, sizeof host_);
    launch_together(read_neighbour, numbers_, out_, late_barrier);
    return results();
  }
  template <class... Arguments>
  void launch_together(void (*kernel)(Arguments...), Arguments... arguments) {
    void* addresses[] = {&arguments...};
    cudaLaunchCooperativeKernel(kernel, kBlocks, kThreads, addresses);
  }
  Sums results() {
    Sums found{};
    cudaMemcpy(found.data(), out_, sizeof found, cudaMemcpyDeviceToHost);
    return found;
  }

  /// Calls work() in every order.
  template <class Work>
  void in_all_orders(const Work& work) {
    for (const Order order : {Order::forward, Order::backward, Order::random}) {
      settings().order = order;
      for (settings().seed = 1; settings().seed <= 3; ++settings().seed) work();
    }
  }

  const Settings before_ = settings();
  std::array<int, kNumbers> host_{};
  int *numbers_ = nullptr, *out_ = nullptr;
};

constexpr Sums kSums = {85344, 605536, 1650016, 3218784};
constexpr Sums kNeighbours = {2, 3, 4, 1};

/// The fault in work() ends the program with `code` and these words.
void expect_fault(int code, const char* words, const std::function<void()>& work) {
  if (kDetectsRaces)
    return;  // ThreadSanitizer, which starts with a thread of its own, looks for races
  EXPECT_EXIT((work(), std::exit(0)), ExitedWithCode(code), words);
}

// ---- correct kernels ----------------------------------------------------------------------------

TEST_F(Faults, CorrectKernelsGiveTheSameInEveryOrder) {
  for (const bool deferred : {false, true}) {
    settings().deferred = deferred;
    in_all_orders([&] {
      EXPECT_EQ(sums(false, numbers_), kSums);
      cudaMemcpy(numbers_, host_.data(), sizeof host_, cudaMemcpyHostToDevice);
      EXPECT_EQ(neighbours(false), kNeighbours);
      cudaMemcpy(numbers_, host_.data(), sizeof host_, cudaMemcpyHostToDevice);
    });
  }
}

TEST_F(Faults, CorrectKernelsRunWhereTheHostIsKeptOut) {
  if (kDetectsRaces) GTEST_SKIP();
  settings().guarded = true;
  EXPECT_EQ(sums(false, numbers_), kSums);
}

// ---- races --------------------------------------------------------------------------------------

TEST_F(Faults, ARaceInABlockGivesOtherSumsInOtherOrders) {
  if (kDetectsRaces) GTEST_SKIP();
  int different = 0;
  in_all_orders([&] { different += sums(true, numbers_) != kSums; });
  EXPECT_GT(different, 0);
}

TEST_F(Faults, AMissingGridBarrierIsSeenInSomeOrder) {
  if (kDetectsRaces) GTEST_SKIP();
  int different = 0;
  in_all_orders([&] { different += neighbours(true) != kNeighbours; });
  EXPECT_GT(different, 0);
}

#if defined(TSAN_FIBERS)
constexpr int kSanitizerReport = 66;  // exit code of a program with reports

TEST_F(Faults, ThreadSanitizerReportsBothRaces) {
  EXPECT_EXIT((sums(true, numbers_), std::exit(0)), ExitedWithCode(kSanitizerReport), "data race");
  EXPECT_EXIT((neighbours(true), std::exit(0)), ExitedWithCode(kSanitizerReport), "data race");
}
#endif

// ---- memory -------------------------------------------------------------------------------------

TEST_F(Faults, WritesBehindAnAllocationAreFound) {
  // Up to the next 256 bytes when the memory is freed, and beyond at once.
  expect_fault(kComplaint, "write out of bounds, found later: byte 12 of an allocation of 12 bytes",
               [&] {
                 int* three = nullptr;
                 cudaMalloc(&three, 3 * sizeof(int));
                 ICLOTH_LAUNCH(write_at, 1, 32)(three, 3l);
                 cudaFree(three);
               });
  expect_fault(kAccessFault, "write_at: device access out of bounds", [&] {
    ICLOTH_LAUNCH(write_at, 1, 32)(out_, long{kNumbers});
  });
}

TEST_F(Faults, WritesBeforeAnAllocationAreFound) {
  expect_fault(kComplaint,
               "write out of bounds, found later: byte -4 of an allocation of 1024 bytes", [&] {
                 ICLOTH_LAUNCH(write_at, 1, 32)(out_, -1l);
                 cudaFree(out_);
               });
}

TEST_F(Faults, ReadsBehindAnAllocationAreFound) {
  expect_fault(kAccessFault, "copy_from: device access out of bounds", [&] {
    ICLOTH_LAUNCH(copy_from, 1, 32)(numbers_, long{kNumbers}, out_);
  });
}

TEST_F(Faults, UseOfFreedMemoryIsFound) {
  expect_fault(kAccessFault, "device access out of bounds, or to freed memory", [&] {
    cudaFree(numbers_);
    ICLOTH_LAUNCH(copy_from, 1, 32)(numbers_, 0l, out_);
  });
}

TEST_F(Faults, FreeingTwiceIsFound) {
  expect_fault(kComplaint, "which is not allocated", [&] {
    cudaFree(out_);
    cudaFree(out_);
  });
}

TEST_F(Faults, CopiesBeyondTheEndAreFound) {
  expect_fault(kComplaint,
               "copy to the host: from: 1024 bytes from byte 4 on of an allocation of 1024",
               [&] { cudaMemcpy(host_.data(), out_ + 1, sizeof host_, cudaMemcpyDeviceToHost); });
}

/// kThreads · 0xcbcbcbcb, in 32 bits.
constexpr auto kPoisonedSum = static_cast<int>(kThreads * 0xcbcbcbcbu);

TEST_F(Faults, FreshMemoryIsPoisoned) {
  if (kDetectsRaces) GTEST_SKIP();
  int* fresh = nullptr;
  cudaMalloc(&fresh, sizeof host_);
  const Sums first = sums(false, fresh);
  cudaFree(fresh);
  EXPECT_EQ(first[0], kPoisonedSum);

  // So that with another poison another result shows that it was used.
  settings().poison = 0;
  cudaMalloc(&fresh, sizeof host_);
  EXPECT_NE(sums(false, fresh), first);
  cudaFree(fresh);
}

TEST_F(Faults, WritesBehindSharedMemoryAreFound) {
  expect_fault(kComplaint, "write behind shared memory", [&] {
    ICLOTH_LAUNCH(write_behind_shared, 1, 32)(out_);
  });
  expect_fault(kComplaint, "write behind shared memory", [&] {
    ICLOTH_LAUNCH(write_behind_shared_of_launch, 1, 32, 100)(out_, 100u);
  });
}

TEST_F(Faults, MoreSharedMemoryThanABlockMayHaveIsFound) {
  ICLOTH_LAUNCH(take_two_kinds_of_shared, 1, 32, 28 << 10)(out_);
  expect_fault(kComplaint,
               "49168 bytes of shared memory, 28688 of them of the launch; at most 49152", [&] {
                 ICLOTH_LAUNCH(take_two_kinds_of_shared, 1, 32, (28 << 10) + 16)(out_);
               });
}

// ---- host and device ----------------------------------------------------------------------------

TEST_F(Faults, HostAccessToDeviceMemoryIsFound) {
  expect_fault(kAccessFault, "host: host access to device memory", [&] {
    settings().guarded = true;
    sums(false, numbers_);
    numbers_[0] = 1;
  });
}

TEST_F(Faults, HostAddressesGivenToAKernelAreFound) {
  expect_fault(kComplaint,
               "sum_of_block: byte 0 of an argument of 8 bytes holds an address of the host",
               [&] { sums(false, host_.data()); });
  expect_fault(kComplaint, "is device memory, not the host's",
               [&] { cudaMemcpy(out_, numbers_, 16, cudaMemcpyHostToDevice); });
}

TEST_F(Faults, ReadingAResultBeforeWaitingForItIsSeenWhenDeferred) {
  int* mail = nullptr;
  cudaHostAlloc(reinterpret_cast<void**>(&mail), sizeof *mail, cudaHostAllocMapped);
  settings().deferred = true;
  ICLOTH_LAUNCH(copy_from, 1, 32)(numbers_, 3l, mail);
  EXPECT_NE(*mail, 9);
  cudaStreamSynchronize(nullptr);
  EXPECT_EQ(*mail, 9);
  cudaFreeHost(mail);
}

// ---- barriers and launches ----------------------------------------------------------------------

TEST_F(Faults, ThreadsAtDifferentBarriersAreFound) {
  expect_fault(kComplaint, "barrier divergence: thread 0 waits at .*, thread 7 at ", [&] {
    ICLOTH_LAUNCH(wait_at_different_barriers, 1, 32)(out_);
  });
}

TEST_F(Faults, ThreadsThatLeaveBeforeABarrierAreFound) {
  expect_fault(kComplaint, "barrier divergence: 1 threads have ended, the others wait at ", [&] {
    ICLOTH_LAUNCH(leave_before_barrier, 1, 32)(out_);
  });
}

TEST_F(Faults, BlocksThatLeaveBeforeAGridBarrierAreFound) {
  expect_fault(kComplaint, "grid barrier: 1 of 4 blocks have ended, the others wait",
               [&] { launch_together(leave_before_grid_barrier, out_); });
}

TEST_F(Faults, MoreBlocksThanCanWaitForEachOtherAreFound) {
  settings().processors = 1;
  expect_fault(kComplaint, "4 blocks that wait for each other, the device holds 2 at once",
               [&] { launch_together(read_neighbour, numbers_, out_, false); });
}

TEST_F(Faults, EmptyLaunchesAreFound) {
  expect_fault(kComplaint, "write_at: launch of 0 blocks of 32 threads", [&] {
    ICLOTH_LAUNCH(write_at, 0, 32)(out_, 0l);
  });
}

// ---- libraries ----------------------------------------------------------------------------------

/// Says something else at every call.
struct Moody {
  int* calls;
  int operator()(int) const { return (*calls)++ % 2; }
};

TEST_F(Faults, APredicateThatIsNotPureIsFound) {
  std::size_t bytes = 0;
  const thrust::counting_iterator<int> all(0);
  cub::DeviceSelect::If(nullptr, bytes, all, out_, out_, 7, Moody{numbers_});
  void* storage = nullptr;
  cudaMalloc(&storage, bytes);
  expect_fault(kComplaint, "the predicate is not pure",
               [&] { cub::DeviceSelect::If(storage, bytes, all, out_, out_, 7, Moody{numbers_}); });
  cudaFree(storage);
}

TEST_F(Faults, TemporaryStorageThatIsTooSmallIsFound) {
  std::size_t bytes = 1;
  expect_fault(kComplaint, "temporary storage of 1 bytes",
               [&] { cub::DeviceScan::ExclusiveSum(out_, bytes, numbers_, numbers_, 7); });
}

}  // namespace
}  // namespace cuda_on_host
