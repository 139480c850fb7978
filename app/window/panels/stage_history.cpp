#include "app/window/panels/stage_history.h"

#include <algorithm>
#include <cmath>
#include <functional>

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

/// What a stage has more of where it takes longer.
struct WorkCount {
  double StepReport::*ms;
  std::int64_t StepReport::*member;
  const char* name;
};
constexpr WorkCount kWorkCounts[] = {
    {&StepReport::ms_proximity, &StepReport::proximity_pairs, "pairs in proximity"},
    {&StepReport::ms_implicit, &StepReport::cg_iterations, "CG iterations"},
    {&StepReport::ms_implicit, &StepReport::linear_solves, "linear solves"},
    {&StepReport::ms_implicit, &StepReport::newton_iterations, "linearisations"},
    {&StepReport::ms_broad_phase, &StepReport::candidate_pairs, "candidate pairs"},
    {&StepReport::ms_ccd, &StepReport::elementary_tests, "elementary tests"},
    {&StepReport::ms_impact_zones, &StepReport::impacts_first, "impacts"},
    {&StepReport::ms_impact_zones, &StepReport::zone_iterations, "zone iterations"},
};

}  // namespace

std::span<const Stage> stages() { return kStages; }

void StageHistory::add(std::vector<StepReport> reports) {
  for (StepReport& report : reports) {
    forget_from(report.step);
    const auto place =
        std::ranges::upper_bound(slowest_, report.ms_total, std::greater(), &StepReport::ms_total);
    slowest_.insert(place, report);
    if (slowest_.size() > kSlowest) slowest_.pop_back();
    reports_.push_back(std::move(report));
    if (reports_.size() > kLength) reports_.pop_front();
  }
}

void StageHistory::cut(std::int64_t step) { forget_from(step + 1); }

void StageHistory::forget_from(std::int64_t step) {
  while (!reports_.empty() && reports_.back().step >= step) reports_.pop_back();
  std::erase_if(slowest_, [&](const StepReport& report) { return report.step >= step; });
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

std::string why_slow(const StepReport& report, const StageHistory& history) {
  // Shorter substeps make everything slower.
  if (report.retries > 0) return std::to_string(report.retries) + " retries with half the step";
  if (report.substeps > 1) return std::to_string(report.substeps) + " substeps for fast cloth";
  if (history.reports().empty()) return "nothing to compare with";

  const auto more = [&](const Stage& stage) { return report.*stage.ms - history.mean(stage.ms); };
  const Stage& stage = *std::ranges::max_element(kStages, {}, more);

  // Of the counts of that stage the one that grew most tells why.
  std::string reason = "no more work than usual: the machine was busy";
  double largest = 1.1;
  for (const WorkCount& count : kWorkCounts) {
    if (count.ms != stage.ms) continue;
    double sum = 0;
    for (const StepReport& other : history.reports())
      sum += static_cast<double>(other.*count.member);
    const double usual = sum / static_cast<double>(history.reports().size());
    const double growth = static_cast<double>(report.*count.member) / std::max(usual, 1.0);
    if (growth <= largest) continue;
    largest = growth;
    reason = std::to_string(report.*count.member) + " " + count.name + ", usually " +
             std::to_string(std::llround(usual));
  }
  return reason;
}

}  // namespace icloth
