// How far `icloth bench paper` is: one line on the terminal with the time left.
#pragma once

#include <chrono>
#include <string>

#include "app/common/interrupt.h"

namespace icloth {

/// Thrown between two steps when a signal asked the run to end.
struct PaperInterrupted {
  const char* signal;
};

/// Work is counted in the seconds that it was estimated to take, and the time left follows from how
/// long the work so far has taken.
class PaperProgress {
 public:
  explicit PaperProgress(bool quiet);
  ~PaperProgress() { clear(); }
  PaperProgress(const PaperProgress&) = delete;
  PaperProgress& operator=(const PaperProgress&) = delete;

  /// Adds work that lies ahead, or with a negative number drops it.
  void plan(double seconds) { total_ += seconds; }
  /// Counts work as done and shows the line. Throws PaperInterrupted.
  void advance(double seconds, const std::string& what);
  /// Throws PaperInterrupted when a signal came.
  void check() const;
  /// Prints a line of results, unless the run is to be quiet.
  void print(const std::string& line);
  /// Removes the line from the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  InterruptWatch interrupts_;
  bool quiet_, terminal_, shown_ = false;
  double total_ = 0, done_ = 0;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace icloth
