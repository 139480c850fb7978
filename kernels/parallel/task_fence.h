// Tells ThreadSanitizer what oneTBB guarantees: tasks see what was written before they were
// started, and what they write is seen after they were waited for. The packaged library is not
// instrumented, so the tool cannot know. In other compilations this file does nothing.
#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
/// The tool asks for these suppressions at its start. They silence reports about oneTBB's own
/// objects, which its headers put here and its workers free; about the copies of a loop's task that
/// pass between the workers before it comes to the fence (what the bodies touch is still watched);
/// about workers that still run at the end; and about Mesa's software driver.
extern "C" __attribute__((used)) inline const char* __tsan_default_suppressions() {
  return "race_top:oneapi/tbb\nrace_top:tbb::detail\nrace_top:bits/atomic_base.h\n"
         "race_top:operator delete[]\nrace_top:kernels/parallel/parallel_for.h\nthread:libtbb\n"
         "race:swrast_dri.so\n";
}
#endif

namespace icloth {

/// Lives as long as a parallel loop, and a Task as long as one of its tasks, however they end.
class TaskFence {
 public:
#if defined(__SANITIZE_THREAD__)
  TaskFence() { __tsan_release(&started_); }
  ~TaskFence() { __tsan_acquire(&ended_); }
#else
  TaskFence() {}
  ~TaskFence() {}
#endif
  TaskFence(const TaskFence&) = delete;
  TaskFence& operator=(const TaskFence&) = delete;

  class Task {
   public:
#if defined(__SANITIZE_THREAD__)
    explicit Task(TaskFence& fence) : fence_(fence) { __tsan_acquire(&fence_.started_); }
    ~Task() { __tsan_release(&fence_.ended_); }
#else
    explicit Task(TaskFence&) {}
    ~Task() {}
#endif
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

#if defined(__SANITIZE_THREAD__)
   private:
    TaskFence& fence_;
#endif
  };

#if defined(__SANITIZE_THREAD__)
 private:
  char started_ = 0, ended_ = 0;
#endif
};

}  // namespace icloth
