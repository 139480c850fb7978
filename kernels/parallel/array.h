// Arrays that the kernels work on: an owning Array on the host side, a View inside kernels.
//
// In the CUDA build the elements are in device memory: a View can be dereferenced in kernels only,
// and the host reads and writes by upload and download, never implicitly.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/parallel/platform.h"

#if defined(__CUDACC__)
#include "kernels/parallel/memory_cuda.h"
#else
#include "kernels/parallel/memory_cpu.h"
#endif

// Bounds checks cost some 10 % of a step, so they are asked for.
#if defined(ICLOTH_CHECK_BOUNDS)
#define ICLOTH_ASSERT_BOUNDS(condition) assert(condition)
#else
#define ICLOTH_ASSERT_BOUNDS(condition) static_cast<void>(0)
#endif

namespace icloth::ICLOTH_BUILD {

/// A pointer and a length. It owns nothing and is copied by value into kernels.
template <class T>
class View {
 public:
  View() = default;
  ICLOTH_HD View(T* data, Index size) : data_(data), size_(size) {}
  template <class U>
  requires std::is_same_v<T, const U> ICLOTH_HD View(View<U> other)
      : data_(other.data()), size_(other.size()) {}

  ICLOTH_HD T& operator[](Index i) const {
    ICLOTH_ASSERT_BOUNDS(i >= 0 && i < size_);
    return data_[i];
  }
  ICLOTH_HD Index size() const { return size_; }
  ICLOTH_HD T* data() const { return data_; }
  /// The view of `count` elements from `first` on.
  ICLOTH_HD View sub(Index first, Index count) const {
    ICLOTH_ASSERT_BOUNDS(first >= 0 && count >= 0 && first <= size_ - count);
    return {data_ + first, count};
  }

 private:
  T* data_ = nullptr;
  Index size_ = 0;
};

/// An owning array whose capacity only grows (by 1.5), so that a steady state allocates nothing.
/// Elements are raw bits: fresh ones are undefined until written. Throws std::bad_alloc (CPU) or
/// std::runtime_error (CUDA) when memory runs out, std::length_error for a negative size.
template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>, "elements are copied as bytes");
  static_assert(alignof(T) <= 64);

 public:
  Array() = default;
  explicit Array(Index n) { resize(n); }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    Array gone(std::move(other));
    swap(gone);
    return *this;
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() {
    if (data_ != nullptr) memory::release(data_);
  }

  Index size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Index capacity() const { return capacity_; }

  /// Sets the length. The content is undefined when it grows beyond the capacity.
  void resize(Index n) {
    if (n > capacity_ || n < 0) Array(grown_capacity(n), Exactly{}).swap(*this);
    size_ = n;
  }
  /// Sets the length and keeps the old content; added elements are undefined.
  void resize_keep(Index n) {
    if (n > capacity_ || n < 0) {
      Array larger(grown_capacity(n), Exactly{});
      if (size_ > 0) memory::copy(larger.data_, data_, bytes(size_));
      swap(larger);
    }
    size_ = n;
  }
  void fill(T value) {
    if (size_ > 0) memory::fill(data_, size_, value);
  }

  View<T> view() { return {data_, size_}; }
  View<const T> view() const { return {data_, size_}; }

  /// Takes length and content from the host.
  void upload(std::span<const T> host) {
    if (host.size() > static_cast<std::size_t>(kMaxSize)) {
      throw std::length_error("array: more than 2^31 - 1 elements");
    }
    resize(static_cast<Index>(host.size()));
    upload_range(0, host);
  }
  void upload(const std::vector<T>& host) { upload(std::span<const T>(host)); }
  /// Overwrites elements first … first + host.size() − 1, which must exist.
  void upload_range(Index first, std::span<const T> host) {
    check_range(first, host.size());
    if (!host.empty()) memory::copy_from_host(data_ + first, host.data(), host.size_bytes());
  }

  /// Sets `host` to the content.
  void download(std::vector<T>& host) const {
    host.resize(static_cast<std::size_t>(size_));
    download_range(0, std::span<T>(host));
  }
  std::vector<T> download() const {
    std::vector<T> host;
    download(host);
    return host;
  }
  /// Fills `host` with the elements from `first` on, which must exist.
  void download_range(Index first, std::span<T> host) const {
    check_range(first, host.size());
    if (!host.empty()) memory::copy_to_host(host.data(), data_ + first, host.size_bytes());
  }

  /// Takes length and content from another array of this build.
  void copy_from(const Array& other) {
    if (this == &other) return;
    resize(other.size_);
    if (size_ > 0) memory::copy(data_, other.data_, bytes(size_));
  }

  void swap(Array& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }
  friend void swap(Array& a, Array& b) noexcept { a.swap(b); }

 private:
  static constexpr Index kMaxSize = 2147483647;
  struct Exactly {};

  Array(Index capacity, Exactly) : capacity_(capacity) {
    data_ = static_cast<T*>(memory::allocate(bytes(capacity)));
#if defined(ICLOTH_CHECK_BOUNDS)
    memory::fill_bytes(data_, 0xff, bytes(capacity));  // NaN and −1: use before writing shows
#endif
  }

  Index grown_capacity(Index n) const {
    if (n < 0) throw std::length_error("array: negative size");
    const std::int64_t grown = std::int64_t{capacity_} + capacity_ / 2;
    return std::max(n, static_cast<Index>(std::min<std::int64_t>(grown, kMaxSize)));
  }
  static std::size_t bytes(Index n) { return static_cast<std::size_t>(n) * sizeof(T); }
  void check_range(Index first, std::size_t count) const {
    if (first < 0 || first > size_ || count > static_cast<std::size_t>(size_ - first)) {
      throw std::out_of_range("array: host range exceeds the array");
    }
  }

  T* data_ = nullptr;
  Index size_ = 0;
  Index capacity_ = 0;
};

}  // namespace icloth::ICLOTH_BUILD
