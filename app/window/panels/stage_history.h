// The reports of the last steps, for plots.
#pragma once

#include <array>
#include <deque>
#include <span>
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
  static constexpr std::size_t kLength = 120;

  /// Adds reports. Those of states that were left by going back are dropped.
  void add(std::vector<StepReport> reports);
  const std::deque<StepReport>& reports() const { return reports_; }
  const StepReport* newest() const { return reports_.empty() ? nullptr : &reports_.back(); }
  const StepReport* find(std::int64_t step) const;
  /// The height of the tallest bar, without the one slowest step in fifty [ms].
  double scale_ms() const;
  /// The mean over the history [ms].
  double mean(double StepReport::*member) const;
  /// Drops the reports of steps after `step`.
  void cut(std::int64_t step);

 private:
  std::deque<StepReport> reports_;
};

}  // namespace icloth
