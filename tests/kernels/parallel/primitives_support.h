// Helpers of the tests of the primitives: sizes, repeatable numbers, numbers of threads, devices.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/parallel/device.h"
#include "kernels/parallel/parallel.h"

#if !defined(__CUDACC__)
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#endif

namespace icloth::ICLOTH_BUILD {

/// Around the sizes of warps, chunks and blocks, and one where all threads have work.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
inline constexpr Index kLargest = 100'000;  // their programs are some 20 times slower
#else
inline constexpr Index kLargest = 1'000'000;
#endif
inline const std::vector<Index> kSizes = {0, 1, 31, 32, 33, 1023, 1025, kLargest};

/// A well-mixed 64-bit number for each i (finalizer of SplitMix64).
ICLOTH_HD inline std::uint64_t mixed(std::uint64_t i) {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// Skips where the device of this build is not there.
class Primitives : public testing::Test {
 protected:
  void SetUp() override {
    std::string reason;
    if (!device_usable(&reason)) GTEST_SKIP() << reason;
  }
};

/// Calls work() with so many threads; the CUDA build has no such choice and just calls it.
template <class Work>
auto with_threads(int threads, const Work& work) {
#if defined(__CUDACC__)
  static_cast<void>(threads);
  return work();
#else
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(work);
#endif
}

/// Result of work() with 1 thread, after checking that 2 and 4 threads give the same.
template <class Work>
auto same_for_all_threads(const Work& work) {
  const auto one = with_threads(1, work);
  EXPECT_TRUE(one == with_threads(2, work)) << "1 and 2 threads differ";
  EXPECT_TRUE(one == with_threads(4, work)) << "1 and 4 threads differ";
  return one;
}

}  // namespace icloth::ICLOTH_BUILD
