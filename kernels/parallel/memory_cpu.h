// The memory of arrays in the CPU builds: ordinary memory, aligned to cache lines.
#pragma once

#include <cstddef>
#include <cstring>
#include <new>

#include "kernels/parallel/platform.h"

namespace icloth::ICLOTH_BUILD::memory {

inline constexpr std::align_val_t kAlignment{64};

inline void* allocate(std::size_t bytes) { return ::operator new(bytes, kAlignment); }
inline void release(void* memory) noexcept { ::operator delete(memory, kAlignment); }

inline void copy_to_host(void* host, const void* array, std::size_t bytes) {
  std::memcpy(host, array, bytes);
}
inline void copy_from_host(void* array, const void* host, std::size_t bytes) {
  std::memcpy(array, host, bytes);
}
inline void copy(void* to, const void* from, std::size_t bytes) { std::memmove(to, from, bytes); }
inline void fill_bytes(void* array, int byte, std::size_t bytes) {
  std::memset(array, byte, bytes);
}
template <class T>
void fill(T* array, Index n, T value) {
  for (Index i = 0; i < n; ++i) array[i] = value;
}

}  // namespace icloth::ICLOTH_BUILD::memory
