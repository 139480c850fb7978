#include "tests/cuda_on_host/device/grid.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/counts.h"
#include "tests/cuda_on_host/device/fiber.h"
#include "tests/cuda_on_host/device/race_detector.h"
#include "tests/cuda_on_host/device/settings.h"
#include "tests/cuda_on_host/device/shared_memory.h"

namespace cuda_on_host {

ThreadPlace* running_thread = nullptr;

namespace {

// ---- threads and blocks -------------------------------------------------------------------------

enum class State { fresh, ready, at_block_barrier, at_grid_barrier, ended };

struct Worker;

/// A thread of the device.
struct Thread : ThreadPlace {
  State state = State::fresh;
  const char* file = nullptr;  ///< of the barrier where it waits
  int line = 0;
  Worker* worker = nullptr;  ///< the fiber that runs it, from its first instruction to its last
};

/// A block that the device holds. The object is used for one block after another.
struct Block : BlockPlace {
  std::vector<Thread> threads;
  std::vector<unsigned> order;  ///< of the threads until the next barrier
  std::size_t next = 0;         ///< place in `order`
  unsigned first_worker = 0;    ///< see worker_of
  SharedMemory shared;
  bool ended = false, at_grid_barrier = false;
  char meeting = 0;  ///< stands for the block's barrier before ThreadSanitizer
};

/// A fiber with the thread that it runs now.
struct Worker {
  Thread* thread = nullptr;
  Fiber fiber;
  Worker() : fiber(&Worker::main, this) {}
  [[noreturn]] static void main(void* self);
};

// The launch that runs, and what stands before ThreadSanitizer for its start, its end, the grid's
// barrier and fences.
const std::function<void()>* running_body = nullptr;
Block* running_block = nullptr;
char start_token = 0, end_token = 0, grid_token = 0, fence_token = 0;

/// Fibers that run no thread now. Never destroyed.
std::vector<Worker*>& idle_workers() {
  static auto* const workers = new std::vector<Worker*>;
  return *workers;
}

/// The next thread of the running block that has not started, in its order; null: none.
Thread* next_fresh_thread() {
  Block& b = *running_block;
  while (b.next < b.order.size()) {
    Thread& t = b.threads[b.order[b.next++]];
    if (t.state == State::fresh) return &t;
  }
  return nullptr;
}

void Worker::main(void* self) {
  Worker& worker = *static_cast<Worker*>(self);
  for (;;) {
    acquire(&start_token);
    (*running_body)();
    release(&end_token);
    worker.thread->state = State::ended;

    // A thread needs a fiber only where it waits: as long as nobody does, this one runs the next
    // thread too. ThreadSanitizer has to see a fiber for each.
    Thread* const next = kDetectsRaces ? nullptr : next_fresh_thread();
    if (next == nullptr) {
      worker.fiber.leave();
    } else {
      next->worker = &worker;
      next->state = State::ready;
      worker.thread = next;
      running_thread = next;
    }
  }
}

/// A fiber for a thread that starts. For ThreadSanitizer thread t of a block is always the same
/// fiber, and different threads are different ones.
Worker* worker_for(const Block& block, const Thread& thread) {
  std::vector<Worker*>& idle = idle_workers();
  if (kDetectsRaces) {
    const std::size_t number = block.first_worker + thread.index.x;
    while (idle.size() <= number) idle.push_back(new Worker);
    return idle[number];
  }
  if (idle.empty()) return new Worker;
  Worker* const worker = idle.back();
  idle.pop_back();
  return worker;
}

/// Runs the thread until it waits or ends.
void enter(Block& block, Thread& thread) {
  if (thread.state == State::fresh) {
    thread.worker = worker_for(block, thread);
    thread.worker->thread = &thread;
    thread.state = State::ready;
  }
  Worker* const worker = thread.worker;
  running_thread = &thread;
  worker->fiber.enter();
  running_thread = nullptr;
  if (!kDetectsRaces && worker->thread->state == State::ended) idle_workers().push_back(worker);
}

/// Called by the running thread: lets the others run.
void wait_at(State barrier, const char* file, int line) {
  auto* const thread = static_cast<Thread*>(running_thread);
  thread->state = barrier;
  thread->file = file;
  thread->line = line;
  thread->worker->fiber.leave();
}

Block& block_of_running_thread() {
  return *const_cast<Block*>(static_cast<const Block*>(running_thread->block));
}

// ---- one block ----------------------------------------------------------------------------------

std::vector<unsigned> order_of(unsigned n) {
  std::vector<unsigned> order(n);
  std::iota(order.begin(), order.end(), 0u);
  if (settings().order == Order::backward) std::reverse(order.begin(), order.end());
  if (settings().order == Order::random)
    for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random_number() % i]);
  return order;
}

void begin_block(Block& block, const LaunchShape& shape, unsigned index) {
  block.index = {index, 0, 0};
  block.dim = shape.threads;
  block.grid = shape.blocks;
  block.threads.assign(shape.threads.x, Thread{});
  for (unsigned t = 0; t < shape.threads.x; ++t) {
    block.threads[t].index = {t, 0, 0};
    block.threads[t].block = &block;
  }
  block.shared.begin(shape.shared_bytes);
  block.ended = block.at_grid_barrier = false;
}

/// All threads that wait must wait at the same barrier, and none may have ended.
void check_meeting(const Block& block) {
  // The first thread that waits says where; every other must agree.
  const Thread* first = nullptr;
  std::size_t ended = 0;
  for (const Thread& t : block.threads) {
    if (t.state == State::ended) {
      ++ended;
    } else if (first == nullptr) {
      first = &t;
    } else if (t.state != first->state || t.line != first->line ||
               std::strcmp(t.file, first->file) != 0) {
      complain("barrier divergence: thread %u waits at %s:%d, thread %u at %s:%d", first->index.x,
               first->file, first->line, t.index.x, t.file, t.line);
    }
  }

  // Threads that have ended will never come.
  if (ended > 0)
    complain("barrier divergence: %zu threads have ended, the others wait at %s:%d", ended,
             first->file, first->line);
}

/// Runs every thread of the block that can run until it waits or ends.
void run_to_barrier(Block& block) {
  // One fiber may run many threads, so those that it has run are passed over here.
  block.order = order_of(static_cast<unsigned>(block.threads.size()));
  block.next = 0;
  running_block = &block;
  for (const unsigned t : block.order) {
    const State state = block.threads[t].state;
    if (state == State::fresh || state == State::ready) enter(block, block.threads[t]);
  }
  running_block = nullptr;

  // The block has ended with its last thread; otherwise it may stand at a barrier.
  const auto has_ended = [](const Thread& t) { return t.state == State::ended; };
  block.ended = std::ranges::all_of(block.threads, has_ended);
  if (block.ended) {
    block.shared.check();
    return;
  }
  check_meeting(block);
  block.at_grid_barrier = block.threads[0].state == State::at_grid_barrier;
  if (block.at_grid_barrier) return;
  for (Thread& t : block.threads) t.state = State::ready;
}

// ---- the grid -----------------------------------------------------------------------------------

/// One launch while it runs.
class GridRun {
 public:
  GridRun(const LaunchShape& shape, bool cooperative);
  void run();

 private:
  bool start_next_block(Block& block);
  void take_turn(std::size_t place);
  void open_grid_barrier();

  const LaunchShape& shape_;
  std::vector<unsigned> order_;  ///< of the blocks
  std::size_t started_ = 0;
  std::vector<Block*> held_;  ///< blocks that the device holds
};

/// Blocks are made once and used by every launch. Never destroyed.
std::vector<std::unique_ptr<Block>>& block_pool() {
  static auto* const pool = new std::vector<std::unique_ptr<Block>>;
  return *pool;
}

GridRun::GridRun(const LaunchShape& shape, bool cooperative)
    : shape_(shape), order_(order_of(shape.blocks.x)) {
  // Blocks of a cooperative kernel wait for each other, so all are there. Others take turns where
  // the order is random, and else run one after another.
  const unsigned turns = settings().order == Order::random ? settings().turns : 1;
  const unsigned held = cooperative ? shape.blocks.x : std::min(shape.blocks.x, turns);
  while (block_pool().size() < held) block_pool().push_back(std::make_unique<Block>());
  for (unsigned k = 0; k < held; ++k) {
    Block& block = *block_pool()[k];
    block.first_worker = k * shape.threads.x;
    if (start_next_block(block)) held_.push_back(&block);
  }
}

bool GridRun::start_next_block(Block& block) {
  if (started_ == order_.size()) return false;
  begin_block(block, shape_, order_[started_++]);
  release(&start_token);  // its threads see what the host and this function did
  return true;
}

void GridRun::run() {
  const bool random = settings().order == Order::random;
  while (!held_.empty()) {
    // A block that can go on: any of them in random order, else the first.
    std::vector<std::size_t> able;
    for (std::size_t k = 0; k < held_.size(); ++k)
      if (!held_[k]->at_grid_barrier) able.push_back(k);
    if (able.empty())
      open_grid_barrier();
    else
      take_turn(random ? able[random_number() % able.size()] : able.front());
  }
  acquire(&end_token);
}

/// In random order a block runs to one of its next barriers, else to its end or the grid's barrier.
void GridRun::take_turn(std::size_t place) {
  Block& block = *held_[place];
  const bool random = settings().order == Order::random;
  do run_to_barrier(block);
  while (!block.ended && !block.at_grid_barrier && (!random || random_number() % 3 != 0));
  if (block.ended && !start_next_block(block))
    held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(place));
}

void GridRun::open_grid_barrier() {
  if (held_.size() != shape_.blocks.x)
    complain("grid barrier: %zu of %u blocks have ended, the others wait",
             shape_.blocks.x - held_.size(), shape_.blocks.x);

  // All blocks wait; it must be at the same barrier.
  const Thread& first = held_[0]->threads[0];
  for (Block* block : held_) {
    const Thread& other = block->threads[0];
    if (other.line != first.line || std::strcmp(other.file, first.file) != 0)
      complain("grid barrier: block %u waits at %s:%d, block %u at %s:%d", held_[0]->index.x,
               first.file, first.line, block->index.x, other.file, other.line);
    block->at_grid_barrier = false;
    for (Thread& t : block->threads) t.state = State::ready;
  }
  ++counts().grid_barriers;
}

}  // namespace

void run_grid(const LaunchShape& shape, bool cooperative, const std::function<void()>& body) {
  running_body = &body;
  GridRun(shape, cooperative).run();
  running_body = nullptr;
}

// ---- what kernels call --------------------------------------------------------------------------

void block_barrier(const char* file, int line) {
  Block& block = block_of_running_thread();
  release(&block.meeting);
  wait_at(State::at_block_barrier, file, line);
  acquire(&block.meeting);
}

void grid_barrier(const char* file, int line) {
  release(&grid_token);
  wait_at(State::at_grid_barrier, file, line);
  acquire(&grid_token);
}

void memory_fence() {
  release(&fence_token);
  acquire(&fence_token);
}

void* shared_memory(const void* key, std::size_t bytes) {
  return block_of_running_thread().shared.declared(key, bytes);
}

unsigned char* shared_memory_of_launch() { return block_of_running_thread().shared.of_launch(); }

/// Only one thread runs at a time, so this is atomic; ThreadSanitizer does not see it.
unsigned atomic_increment(unsigned* at, unsigned most) {
  const unsigned old = *at;
  *at = old >= most ? 0 : old + 1;
  return old;
}

}  // namespace cuda_on_host
