// The division of a step into substeps.
#pragma once

#include <cstdint>

namespace icloth {

/// Start and length of the substeps of a step. The length of a substep at level k is that of the
/// step halved k times. Times are counted in the smallest substeps, so that they add up to the step
/// without rounding.
class SubstepClock {
 public:
  /// For a step from `time` over `dt` [s], which may be halved `max_level` times. The first substep
  /// is at `level`.
  SubstepClock(double time, double dt, int max_level, int level)
      : time_(time),
        dt_(dt),
        max_level_(max_level),
        level_(level),
        whole_(std::int64_t{1} << max_level) {}

  bool is_done() const { return done_ == whole_; }
  bool is_shortest() const { return level_ == max_level_; }

  /// When the next substep starts [s].
  double start() const {
    return time_ + dt_ * static_cast<double>(done_) / static_cast<double>(whole_);
  }
  /// How long the next substep is [s].
  double length() const { return dt_ / static_cast<double>(std::int64_t{1} << level_); }

  /// Goes to the end of a substep. The next one is twice as long where `least_level` allows it and
  /// where a substep of that length can start: at a multiple of its length.
  void advance(int least_level) {
    done_ += whole_ >> level_;
    if (level_ > least_level && done_ % (whole_ >> (level_ - 1)) == 0) --level_;
  }

  /// Halves the next substep; false where it is the shortest already.
  bool halve() {
    if (is_shortest()) return false;
    ++level_;
    return true;
  }

 private:
  double time_, dt_;  ///< [s]
  int max_level_, level_;
  std::int64_t whole_, done_ = 0;  ///< [shortest substeps]
};

}  // namespace icloth
