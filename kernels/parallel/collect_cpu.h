// `collect` on the CPU: one pass into buffers that the running tasks hold, then a copy in order.
#pragma once

namespace icloth::ICLOTH_BUILD {
namespace detail {

/// Appends to a buffer. Copies of an emitter append to the same buffer.
template <class T>
class Emitter {
 public:
  explicit Emitter(std::vector<T>& out) : out_(&out) {}
  void operator()(const T& value) const { out_->push_back(value); }

 private:
  std::vector<T>* out_;
};

/// Buffers for as many tasks as ever ran at once; their capacity is kept between calls.
template <class T>
class BufferPool {
 public:
  using Buffer = std::vector<T>;

  /// Holds a buffer for the life time of the object.
  class Lease {
   public:
    explicit Lease(BufferPool& pool) : pool_(pool), buffer_(pool.take()) {}
    ~Lease() { pool_.give_back(buffer_); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Buffer& operator*() const { return *buffer_; }

   private:
    BufferPool& pool_;
    Buffer* buffer_;
  };

  /// Empties all buffers and makes all of them free.
  void reset() {
    free_.clear();
    for (const auto& buffer : buffers_) {
      buffer->clear();
      free_.push_back(buffer.get());
    }
  }

 private:
  Buffer* take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
      buffers_.push_back(std::make_unique<Buffer>());
      free_.reserve(buffers_.size());  // so that give_back cannot throw
      return buffers_.back().get();
    }
    Buffer* buffer = free_.back();
    free_.pop_back();
    return buffer;
  }
  void give_back(Buffer* buffer) {
    const std::lock_guard lock(mutex_);
    free_.push_back(buffer);
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Buffer>> buffers_;
  std::vector<Buffer*> free_;
};

/// The place of the output of one chunk.
template <class T>
struct ChunkOutput {
  const std::vector<T>* buffer;
  std::size_t first;  // in the buffer
  std::size_t count;
  std::size_t start;  // in the result
};

/// Sets `start` of all chunks and returns the total.
template <class T>
std::size_t place_chunks(View<ChunkOutput<T>> chunks) {
  std::size_t total = 0;
  for (Index c = 0; c < chunks.size(); ++c) {
    chunks[c].start = total;
    total += chunks[c].count;
  }
  return total;
}

}  // namespace detail

template <class T, class F>
Index collect(const char* name, Index n, const F& f, Array<T>& out) {
  // The pool belongs to the calling thread, as two simulators may run at once; the reference lets
  // the tasks on other threads use it.
  const ProfileScope scope(name);
  thread_local detail::BufferPool<T> thread_pool;
  detail::BufferPool<T>& pool = thread_pool;
  pool.reset();

  // Chunks have a fixed size, so their order alone decides the result. Each task appends the output
  // of its chunks to one buffer and notes where it lies.
  const Index count = detail::chunk_count(n, detail::kCollectChunk);
  const auto chunks = detail::scratch<detail::ChunkOutput<T>, 4>(count);
  parallel_for(count, 2, 1, [&](Index begin, Index end) {
    const typename detail::BufferPool<T>::Lease buffer(pool);
    for (Index c = begin; c < end; ++c) {
      const Index first = c * detail::kCollectChunk;
      const Index last = first + std::min(detail::kCollectChunk, n - first);
      const std::size_t before = (*buffer).size();
      detail::Emitter<T> emit(*buffer);
      for (Index i = first; i < last; ++i) f(i, emit);
      chunks[c] = {&*buffer, before, (*buffer).size() - before, 0};
    }
  });

  // The total decides the length of the result before anything is copied.
  const std::size_t total = detail::place_chunks(chunks);
  if (total > static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
    detail::throw_too_long(name);
  }
  out.resize(static_cast<Index>(total));
  T* const result = out.view().data();

  // Copying one chunk is little work, hence the large grain.
  parallel_for(count, 1024, 256, [&](Index begin, Index end) {
    for (Index c = begin; c < end; ++c) {
      const detail::ChunkOutput<T>& chunk = chunks[c];
      std::copy_n(chunk.buffer->data() + chunk.first, chunk.count, result + chunk.start);
    }
  });
  return out.size();
}

}  // namespace icloth::ICLOTH_BUILD
