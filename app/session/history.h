// States to step back to, in bounded memory.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "sim/scene/input.h"
#include "sim/simulator.h"

namespace icloth {

/// Everything that is needed to go on from the start of a step.
struct HistoryEntry {
  Snapshot snapshot;
  std::size_t recorded_steps = 0;  ///< length of the recording at that moment
  Parameters parameters;           ///< in force for the step before
};

/// The newest entries that fit into a number of bytes; at least one is kept.
class History {
 public:
  explicit History(std::size_t bytes) : limit_(bytes) {}

  void push(HistoryEntry entry);
  /// Takes the entry `count` back (1 is the newest) and forgets those after it; none: nullopt.
  std::optional<HistoryEntry> rewind(std::size_t count);
  void clear();

  std::size_t size() const { return entries_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  std::deque<HistoryEntry> entries_;
  std::size_t limit_, bytes_ = 0;
};

}  // namespace icloth
