// The time spent in each primitive, by the name that its caller gave it.
//
// One table serves all builds in the program. It is off by default: a call then costs one relaxed
// load.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace icloth {

/// One row of the profile.
struct ProfileRow {
  std::string name;        ///< as given to the primitive
  std::int64_t calls = 0;  ///< since the last reset
  double ms = 0;           ///< wall time of all calls together [ms]
};

namespace detail {

struct ProfileTable {
  std::atomic<bool> enabled{false};
  std::mutex mutex;  // guards what follows
  std::vector<ProfileRow> rows;
  std::map<std::string, std::size_t, std::less<>> row_of_name;
};

inline ProfileTable& profile_table() {
  static ProfileTable table;
  return table;
}

inline void profile_add(const char* name, double ms) {
  ProfileTable& table = profile_table();
  const std::lock_guard lock(table.mutex);
  auto found = table.row_of_name.find(name);
  if (found == table.row_of_name.end()) {
    found = table.row_of_name.emplace(name, table.rows.size()).first;
    table.rows.push_back({name, 0, 0});
  }
  ProfileRow& row = table.rows[found->second];
  ++row.calls;
  row.ms += ms;
}

}  // namespace detail

/// Starts or stops measuring. While it is on, CUDA launches are waited for, so a step is slower.
inline void profile_enable(bool on) {
  detail::profile_table().enabled.store(on, std::memory_order_relaxed);
}

inline bool profile_enabled() {
  return detail::profile_table().enabled.load(std::memory_order_relaxed);
}

/// Rows in the order in which the names first appeared.
inline std::vector<ProfileRow> profile_rows() {
  detail::ProfileTable& table = detail::profile_table();
  const std::lock_guard lock(table.mutex);
  return table.rows;
}

/// Forgets all rows.
inline void profile_reset() {
  detail::ProfileTable& table = detail::profile_table();
  const std::lock_guard lock(table.mutex);
  table.rows.clear();
  table.row_of_name.clear();
}

/// Adds the life time of the object to the row `name`; `wait` (may be null) ends pending device
/// work.
class ProfileScope {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProfileScope(const char* name, void (*wait)() = nullptr)
      : name_(profile_enabled() ? name : nullptr), wait_(wait) {
    if (name_ != nullptr) start_ = Clock::now();
  }
  ~ProfileScope() {
    if (name_ != nullptr) stop();
  }
  ProfileScope(const ProfileScope&) = delete;
  ProfileScope& operator=(const ProfileScope&) = delete;

 private:
  void stop() {
    if (wait_ != nullptr) wait_();
    const std::chrono::duration<double, std::milli> ms = Clock::now() - start_;
    detail::profile_add(name_, ms.count());
  }

  const char* name_;
  void (*wait_)();
  Clock::time_point start_;
};

}  // namespace icloth
