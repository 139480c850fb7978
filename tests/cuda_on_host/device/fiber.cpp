#include "tests/cuda_on_host/device/fiber.h"

#include <sys/mman.h>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/race_detector.h"

#if !defined(__x86_64__)
#error "the switch between fibers is written for x86-64"
#endif

// cuda_on_host_switch(save, to) keeps what a called function must keep (six registers and the
// address to return to) on the stack, stores the top of the stack in *save, and does the reverse on
// the stack whose top is `to`. A fresh stack returns to cuda_on_host_begin, which calls the
// function in r12 with the argument in rbx.
__asm__(R"(
.text
.globl cuda_on_host_switch
.type cuda_on_host_switch, @function
cuda_on_host_switch:
  push %rbp
  push %rbx
  push %r12
  push %r13
  push %r14
  push %r15
  mov %rsp, (%rdi)
  mov %rsi, %rsp
  pop %r15
  pop %r14
  pop %r13
  pop %r12
  pop %rbx
  pop %rbp
  ret
.size cuda_on_host_switch, .-cuda_on_host_switch

.globl cuda_on_host_begin
.type cuda_on_host_begin, @function
cuda_on_host_begin:
  mov %rbx, %rdi
  call *%r12
  ud2
.size cuda_on_host_begin, .-cuda_on_host_begin
)");
extern "C" void cuda_on_host_switch(void** save, void* to);
extern "C" void cuda_on_host_begin();

namespace cuda_on_host {

Fiber::Fiber(void (*main)(void*), void* argument) : own_identity_(create_fiber()) {
  constexpr int kAccess = PROT_READ | PROT_WRITE;
  constexpr int kKind = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
  void* stack = mmap(nullptr, kStackBytes, kAccess, kKind, -1, 0);
  if (stack == MAP_FAILED) complain("no memory for the stack of a fiber");
  stack_ = static_cast<unsigned char*>(stack);
  mprotect(stack_, 4096, PROT_NONE);

  // The stack as cuda_on_host_switch leaves it, the top first: r15, r14, r13, r12, rbx, rbp and
  // the address to return to. Where that was, the stack is aligned to 16 bytes, as a call needs.
  auto** const top = reinterpret_cast<void**>(stack_ + kStackBytes - 64) - 7;
  void* const words[7] = {nullptr,
                          nullptr,
                          nullptr,
                          reinterpret_cast<void*>(main),
                          argument,
                          nullptr,
                          reinterpret_cast<void*>(&cuda_on_host_begin)};
  for (int k = 0; k < 7; ++k) top[k] = words[k];
  own_top_ = top;
}

Fiber::~Fiber() { munmap(stack_, kStackBytes); }

void Fiber::enter() {
  scheduler_identity_ = current_fiber();
  switch_fiber(own_identity_);
  cuda_on_host_switch(&scheduler_top_, own_top_);
}

void Fiber::leave() {
  switch_fiber(scheduler_identity_);
  cuda_on_host_switch(&own_top_, scheduler_top_);
}

}  // namespace cuda_on_host
