// The reports of the last steps, for plots, and of the slowest ones of the run.
#pragma once

#include <array>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/state/report.h"

namespace icloth {

/// A stage of the step as plots show it.
struct Stage {
  std::string_view name;
  double StepReport::*ms;
  std::uint32_t colour;  ///< 0xAABBGGRR
};
std::span<const Stage> stages();

/// Keeps the reports of the last steps.
class StageHistory {
 public:
  static constexpr std::size_t kLength = 120, kSlowest = 5;

  /// Adds reports. Those of states that were left by going back are dropped.
  void add(std::vector<StepReport> reports);
  const std::deque<StepReport>& reports() const { return reports_; }
  const StepReport* newest() const { return reports_.empty() ? nullptr : &reports_.back(); }
  const StepReport* find(std::int64_t step) const;
  /// The slowest steps of the run, the slowest first; at most kSlowest.
  const std::vector<StepReport>& slowest() const { return slowest_; }
  /// The height of the tallest bar, without the one slowest step in fifty [ms].
  double scale_ms() const;
  /// The mean over the history [ms].
  double mean(double StepReport::*member) const;
  /// Drops the reports of steps after `step`.
  void cut(std::int64_t step);

 private:
  void forget_from(std::int64_t step);

  std::deque<StepReport> reports_;
  std::vector<StepReport> slowest_;
};

/// What a step had more of than the steps of the history on average, for people: shorter substeps,
/// or the counts of the stage that took the longest beyond its mean.
std::string why_slow(const StepReport& report, const StageHistory& history);

}  // namespace icloth
