// Parallel loops of the host, on which the CPU builds' primitives stand.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "kernels/parallel/platform.h"
#include "kernels/parallel/task_fence.h"

namespace icloth {

/// Calls body(first, last) over ranges that cover 0 … n − 1, on this thread alone when n is below
/// `serial_below`. The loop is isolated: while this thread waits it must not start other work that
/// would use its scratch memory.
template <class Body>
void parallel_for(Index n, Index serial_below, Index grain, const Body& body) {
  if (n <= 0) return;
  if (n < serial_below) return body(Index{0}, n);
  TaskFence fence;
  const auto task = [&body, &fence](const tbb::blocked_range<Index>& r) {
    const TaskFence::Task scope(fence);
    body(r.begin(), r.end());
  };
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<Index>(0, n, static_cast<std::size_t>(grain)), task);
  });
}

}  // namespace icloth
