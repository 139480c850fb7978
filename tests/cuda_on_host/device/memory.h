// Memory of the device: poisoned when it is fresh, guarded at its ends, and never handed out twice.
#pragma once

#include <cstddef>

namespace cuda_on_host {

/// `bytes` > 0 of fresh device memory, aligned to 256 bytes; null when the device is full. The page
/// behind it cannot be touched; the bytes up to that page, and before it, must stay as they are.
void* allocate_device(std::size_t bytes);

/// Complains when `memory` is not allocated, or when something was written beside it. The addresses
/// cannot be touched from then on. Returns how many bytes it had.
std::size_t free_device(void* memory);

/// Looks at the bytes beside every allocation.
void check_device_memory();

/// Memory of the host that the device may write to as well, poisoned.
void* allocate_pinned(std::size_t bytes);
void free_pinned(void* memory);

/// Complains unless [p, p + bytes) lies in one allocation of the device; `what` names the caller.
void require_device(const char* what, const void* p, std::size_t bytes);
/// Complains when p is an address of the device.
void require_host(const char* what, const void* p, std::size_t bytes);
/// True when p is memory that kernels may use.
bool reachable_from_device(const void* p);

/// While one lives, device memory can be touched. With settings().guarded it cannot otherwise.
class DeviceAccess {
 public:
  DeviceAccess();
  ~DeviceAccess();
  DeviceAccess(const DeviceAccess&) = delete;
  DeviceAccess& operator=(const DeviceAccess&) = delete;
};

}  // namespace cuda_on_host
