#include "tests/cuda_on_host/device/memory.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/race_detector.h"
#include "tests/cuda_on_host/device/settings.h"
#include "tests/cuda_on_host/kernel.h"

namespace cuda_on_host {
namespace {

constexpr std::size_t kPage = 4096, kAlignment = 256;
constexpr unsigned char kBeside = 0xa5;                   ///< bytes beside an allocation
constexpr std::size_t kMostBytes = std::size_t{8} << 30;  ///< of one allocation
// Addresses are never used again, so there must be many. ThreadSanitizer has fewer to give.
constexpr std::size_t kAddresses = std::size_t{1} << (kDetectsRaces ? 36 : 40);
constexpr std::size_t kPinnedBytes = 1 << 20;

constexpr int kReadWrite = PROT_READ | PROT_WRITE;

std::size_t round_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

/// An allocation ends with its last page; what comes before `data` and behind `data + bytes` in its
/// pages is filled with kBeside. One more page, which cannot be touched, follows.
struct Allocation {
  unsigned char* pages = nullptr;
  std::size_t page_bytes = 0;
  unsigned char* data = nullptr;
  std::size_t bytes = 0;
};

/// A range of addresses that are handed out one after another.
struct Range {
  unsigned char *begin = nullptr, *next = nullptr, *end = nullptr;

  void reserve(std::size_t bytes) {
    void* at = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) complain("cannot reserve %zu bytes of addresses", bytes);
    begin = next = static_cast<unsigned char*>(at);
    end = begin + bytes;
  }
  bool holds(const void* p) const { return p >= begin && p < end; }
};

Range arena, pinned;
int access_depth = 0;  ///< living DeviceAccess
bool closed = false;   ///< device memory cannot be touched

/// Allocations that live, by their data. Never destroyed: static objects free memory at exit.
std::map<const void*, Allocation>& living() {
  static auto* const map = new std::map<const void*, Allocation>;
  return *map;
}

/// Says what an access that the processor refused was, and ends the program.
void on_access_fault(int, siginfo_t* info, void*) {
  const auto* at = static_cast<const unsigned char*>(info->si_addr);
  const char* kind = "access to no memory at all";
  if (arena.holds(at))
    kind = access_depth > 0 ? "device access out of bounds, or to freed memory"
                            : "host access to device memory";
  std::fprintf(stderr, "cuda_on_host: %s: %s at %p", running_operation ? running_operation : "host",
               kind, info->si_addr);
  if (running_thread != nullptr)
    std::fprintf(stderr, ", thread %u of block %u", running_thread->index.x,
                 running_thread->block->index.x);
  std::fprintf(stderr, "\n");

  // Which allocation is near, if any.
  for (const auto& [data, a] : living())
    if (at >= a.pages && at < a.pages + a.page_bytes + kPage)
      std::fprintf(stderr, "  byte %td of an allocation of %zu bytes\n", at - a.data, a.bytes);
  print_calls();
  _exit(kAccessFault);
}

void install_fault_handler() {
  if (kDetectsRaces) return;  // ThreadSanitizer has a handler of its own
  // On a stack of its own: the fault may be that of a fiber whose stack is full.
  static unsigned char stack[1 << 16];
  stack_t alternative{};
  alternative.ss_sp = stack;
  alternative.ss_size = sizeof stack;
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_access_fault;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigaction(SIGSEGV, &action, nullptr);
  sigaction(SIGBUS, &action, nullptr);
}

void start() {
  if (arena.begin != nullptr) return;
  arena.reserve(kAddresses);
  pinned.reserve(kPinnedBytes);
  mprotect(pinned.begin, kPinnedBytes, kReadWrite);
  install_fault_handler();
  std::atexit(check_device_memory);
}

/// Opens or closes all memory of the device, page by page of what is allocated: the pages between
/// stay closed.
void set_access(int protection) {
  for (const auto& [data, a] : living()) mprotect(a.pages, a.page_bytes, protection);
  closed = protection == PROT_NONE;
}

void check_beside(const Allocation& a) {
  for (const unsigned char* p = a.pages; p < a.pages + a.page_bytes; ++p) {
    if (p == a.data) p += a.bytes;
    if (p == a.pages + a.page_bytes) return;
    if (*p != kBeside)
      complain("write out of bounds, found later: byte %td of an allocation of %zu bytes",
               p - a.data, a.bytes);
  }
}

/// The allocation that holds p, or null.
const Allocation* find(const void* p) {
  auto above = living().upper_bound(p);
  if (above == living().begin()) return nullptr;
  const Allocation& a = std::prev(above)->second;
  return p < a.data + a.bytes ? &a : nullptr;
}

}  // namespace

void* allocate_device(std::size_t bytes) {
  start();
  if (bytes > kMostBytes) return nullptr;
  // As many pages as it takes, the data at their end.
  Allocation a;
  a.bytes = bytes;
  a.page_bytes = round_up(bytes, kPage);
  a.pages = arena.next;
  a.data = a.pages + a.page_bytes - round_up(bytes, kAlignment);
  if (a.page_bytes + kPage > static_cast<std::size_t>(arena.end - arena.next)) return nullptr;
  arena.next += a.page_bytes + kPage;

  // Fresh content, which nobody may rely on.
  mprotect(a.pages, a.page_bytes, kReadWrite);
  std::memset(a.pages, kBeside, a.page_bytes);
  std::memset(a.data, settings().poison, bytes);
  if (closed) mprotect(a.pages, a.page_bytes, PROT_NONE);
  living()[a.data] = a;
  return a.data;
}

std::size_t free_device(void* memory) {
  const auto found = living().find(memory);
  if (found == living().end()) complain("cudaFree of %p, which is not allocated", memory);
  {
    const DeviceAccess access;
    check_beside(found->second);
  }
  // A fresh mapping in its place gives the pages back and cannot be touched.
  constexpr int kKind = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED;
  mmap(found->second.pages, found->second.page_bytes, PROT_NONE, kKind, -1, 0);
  const std::size_t bytes = found->second.bytes;
  living().erase(found);
  return bytes;
}

void check_device_memory() {
  const DeviceAccess access;
  for (const auto& [data, a] : living()) check_beside(a);
}

void* allocate_pinned(std::size_t bytes) {
  start();
  unsigned char* const memory = pinned.next;
  if (bytes + kAlignment > static_cast<std::size_t>(pinned.end - memory)) return nullptr;
  pinned.next += round_up(bytes, kAlignment) + kAlignment;
  std::memset(memory, settings().poison, bytes);
  return memory;
}

void free_pinned(void* memory) {
  if (!pinned.holds(memory)) complain("cudaFreeHost of %p, which is no pinned memory", memory);
}

void require_device(const char* what, const void* p, std::size_t bytes) {
  if (bytes == 0) return;
  const Allocation* a = find(p);
  if (a == nullptr) complain("%s: %p is no device memory", what, p);
  const auto first = static_cast<std::size_t>(static_cast<const unsigned char*>(p) - a->data);
  if (bytes > a->bytes - first)
    complain("%s: %zu bytes from byte %zu on of an allocation of %zu", what, bytes, first,
             a->bytes);
}

void require_host(const char* what, const void* p, std::size_t bytes) {
  if (bytes > 0 && arena.holds(p)) complain("%s: %p is device memory, not the host's", what, p);
}

bool reachable_from_device(const void* p) { return arena.holds(p) || pinned.holds(p); }

DeviceAccess::DeviceAccess() {
  if (access_depth++ == 0 && closed) set_access(kReadWrite);
}
DeviceAccess::~DeviceAccess() {
  if (--access_depth == 0 && settings().guarded) set_access(PROT_NONE);
}

}  // namespace cuda_on_host
