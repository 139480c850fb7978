#include "app/window/panels/stage_history.h"

#include <algorithm>

namespace icloth {

namespace {

constexpr Stage kStages[] = {
    {"proximity", &StepReport::ms_proximity, 0xFFEFB05E},
    {"implicit", &StepReport::ms_implicit, 0xFF8CC868},
    {"broad_phase", &StepReport::ms_broad_phase, 0xFF5CBAF0},
    {"ccd", &StepReport::ms_ccd, 0xFF6A86F2},
    {"impact_zones", &StepReport::ms_impact_zones, 0xFFD98AB9},
    {"other", &StepReport::ms_other, 0xFF8A8078},
};

}  // namespace

std::span<const Stage> stages() { return kStages; }

void StageHistory::add(std::vector<StepReport> reports) {
  for (StepReport& report : reports) {
    while (!reports_.empty() && reports_.back().step >= report.step) reports_.pop_back();
    reports_.push_back(std::move(report));
    if (reports_.size() > kLength) reports_.pop_front();
  }
}

void StageHistory::cut(std::int64_t step) {
  while (!reports_.empty() && reports_.back().step > step) reports_.pop_back();
}

const StepReport* StageHistory::find(std::int64_t step) const {
  const auto it = std::ranges::find(reports_, step, &StepReport::step);
  return it == reports_.end() ? nullptr : &*it;
}

double StageHistory::scale_ms() const {
  // The slowest steps are left out of the scale, so that one hiccup does not flatten the others.
  if (reports_.empty()) return 1;
  std::vector<double> totals;
  for (const StepReport& report : reports_) totals.push_back(report.ms_total);
  std::ranges::sort(totals);
  return std::max(1e-3, totals[(totals.size() - 1) * 49 / 50]);
}

double StageHistory::mean(double StepReport::*member) const {
  double sum = 0;
  for (const StepReport& report : reports_) sum += report.*member;
  return reports_.empty() ? 0 : sum / static_cast<double>(reports_.size());
}

}  // namespace icloth
