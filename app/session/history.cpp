#include "app/session/history.h"

#include <cmath>
#include <iterator>
#include <utility>

namespace icloth {

namespace {

std::size_t size_of(const HistoryEntry& entry) {
  return sizeof entry - sizeof entry.snapshot + memory_bytes(entry.snapshot) +
         entry.positions.size() * sizeof(Vec3f);
}

}  // namespace

void History::push(HistoryEntry entry) {
  const std::size_t now = entry.recorded_steps, bytes = size_of(entry);
  const auto [place, is_new] = entries_.try_emplace(now, std::move(entry));
  if (!is_new) return;  // equal steps lead to equal states
  bytes_ += bytes;
  while (bytes_ > limit_) {
    const auto victim = least_needed(now);
    if (victim == entries_.end()) return;
    bytes_ -= size_of(victim->second);
    entries_.erase(victim);
  }
}

/// The state without which the fewest steps have to be made again, in proportion to how far it is
/// from the present one: gaps grow with the distance. The end: none may go.
History::Entries::iterator History::least_needed(std::size_t now) {
  auto least = entries_.end();
  double least_share = 0;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    const auto next = std::next(entry);
    if (entry == entries_.begin() || next == entries_.end() || entry->first == now) continue;
    const double gap = static_cast<double>(next->first - std::prev(entry)->first);
    const double distance = std::fabs(static_cast<double>(entry->first) - static_cast<double>(now));
    if (least != entries_.end() && gap / distance >= least_share) continue;
    least = entry;
    least_share = gap / distance;
  }
  return least;
}

const HistoryEntry* History::before(std::size_t steps) const {
  const auto after = entries_.upper_bound(steps);
  return after == entries_.begin() ? nullptr : &std::prev(after)->second;
}

void History::forget_after(std::size_t steps) { forget_all_from(entries_.upper_bound(steps)); }

void History::forget_all_from(Entries::iterator first) {
  for (auto entry = first; entry != entries_.end(); ++entry) bytes_ -= size_of(entry->second);
  entries_.erase(first, entries_.end());
}

}  // namespace icloth
