#include "app/session/history.h"

#include <utility>

namespace icloth {

namespace {

std::size_t size_of(const HistoryEntry& entry) {
  return sizeof entry - sizeof entry.snapshot + memory_bytes(entry.snapshot);
}

}  // namespace

void History::push(HistoryEntry entry) {
  bytes_ += size_of(entry);
  entries_.push_back(std::move(entry));
  while (bytes_ > limit_ && entries_.size() > 1) {
    bytes_ -= size_of(entries_.front());
    entries_.pop_front();
  }
}

std::optional<HistoryEntry> History::rewind(std::size_t count) {
  if (count == 0 || count > entries_.size()) return std::nullopt;
  for (std::size_t k = 1; k < count; ++k) {
    bytes_ -= size_of(entries_.back());
    entries_.pop_back();
  }
  bytes_ -= size_of(entries_.back());
  HistoryEntry entry = std::move(entries_.back());
  entries_.pop_back();
  return entry;
}

void History::clear() {
  entries_.clear();
  bytes_ = 0;
}

}  // namespace icloth
