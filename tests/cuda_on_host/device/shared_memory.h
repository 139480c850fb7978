// The shared memory of one block.
#pragma once

#include <cstddef>
#include <vector>

namespace cuda_on_host {

/// Most that a block may have without asking for more, static and of the launch together.
inline constexpr std::size_t kMostSharedBytes = 48 << 10;

class SharedMemory {
 public:
  SharedMemory() = default;
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  /// Forgets everything; the next block begins.
  void begin(std::size_t bytes_of_launch);
  /// See shared_memory in kernel.h.
  void* declared(const void* key, std::size_t bytes);
  unsigned char* of_launch() const { return memory_ + kDeclaredRoom; }
  /// Looks for writes behind each array and at the size of all together. A block ends.
  void check() const;

 private:
  struct Declaration {
    const void* key;
    std::size_t first, bytes;
  };
  static constexpr std::size_t kDeclaredRoom = 64 << 10;
  static constexpr std::size_t kAllBytes = 128 << 10;

  void fill(std::size_t first, std::size_t bytes) const;
  void check_behind(std::size_t end) const;

  unsigned char* memory_ = nullptr;
  std::vector<Declaration> declarations_;
  std::size_t of_launch_ = 0;  ///< bytes
};

}  // namespace cuda_on_host
