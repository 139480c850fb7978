// ThreadSanitizer learns about the device here: each of its threads is a fiber, and only barriers,
// fences and the order of launches put one access before another. Other builds do nothing here.
//
// The emulation itself is compiled without the sanitizer's checks, or its own bookkeeping would
// hide races; TSAN_FIBERS is defined where the kernels are compiled with them.
#pragma once

#if defined(TSAN_FIBERS)
#include <sanitizer/tsan_interface.h>
#endif

namespace cuda_on_host {

#if defined(TSAN_FIBERS)
inline constexpr bool kDetectsRaces = true;
inline void acquire(void* token) { __tsan_acquire(token); }
inline void release(void* token) { __tsan_release(token); }
inline void* current_fiber() { return __tsan_get_current_fiber(); }
inline void* create_fiber() { return __tsan_create_fiber(0); }
/// Announces that the next instructions are those of another fiber, without ordering the two.
inline void switch_fiber(void* fiber) {
  __tsan_switch_to_fiber(fiber, __tsan_switch_to_fiber_no_sync);
}
#else
inline constexpr bool kDetectsRaces = false;
inline void acquire(void*) {}
inline void release(void*) {}
inline void* current_fiber() { return nullptr; }
inline void* create_fiber() { return nullptr; }
inline void switch_fiber(void*) {}
#endif

}  // namespace cuda_on_host
