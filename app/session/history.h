// States of a run to go back to, in bounded memory: all of the newest ones, and fewer and fewer the
// further they are away. The steps between two of them are made again.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "sim/scene/input.h"
#include "sim/simulator.h"

namespace icloth {

/// Everything that is needed to go on from the start of a step.
struct HistoryEntry {
  Snapshot snapshot;
  std::size_t recorded_steps = 0;  ///< length of the recording at that moment
  Parameters parameters;           ///< in force for the step before
  /// Of all vertices of the scene [m]; the snapshot has fewer where a seam was welded.
  std::vector<Vec3f> positions{};
};

/// The states that fit into a number of bytes; the first and the newest one are always kept.
class History {
 public:
  explicit History(std::size_t bytes) : limit_(bytes) {}

  /// Adds the state in which the run is now.
  void push(HistoryEntry entry);
  /// The newest state that is not after so many steps; null: none. Valid until a state is added or
  /// forgotten.
  const HistoryEntry* before(std::size_t steps) const;
  /// Forgets the states after so many steps.
  void forget_after(std::size_t steps);
  void clear() { forget_all_from(entries_.begin()); }

  std::size_t size() const { return entries_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  using Entries = std::map<std::size_t, HistoryEntry>;  // by recorded_steps

  void forget_all_from(Entries::iterator first);
  Entries::iterator least_needed(std::size_t now);

  Entries entries_;
  std::size_t limit_, bytes_ = 0;
};

}  // namespace icloth
