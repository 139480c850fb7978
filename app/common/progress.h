// One line on the terminal that tells how far a run is.
#pragma once

#include <chrono>
#include <string>

namespace icloth {

/// A time for a line of progress: "42 s", "3:05 min", "1:20 h".
std::string duration_text(double seconds);

/// A line on stderr when that is a terminal, from the second second on; it is erased at the end.
class Progress {
 public:
  Progress(std::string what, long total, bool quiet);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(long done);
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  long total_;
  bool enabled_, shown_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace icloth
