#include "app/suites/validation/case_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "app/suites/suite_case.h"

namespace icloth::validation {

Simulator& CaseRun::start(std::shared_ptr<const Scene> scene) {
  simulator_ = make_simulator(settings_.build, std::move(scene));
  return *simulator_;
}

StepReport CaseRun::step() {
  const StepReport report = simulator_->step({});
  ++result_.steps;
  if (!report.accepted) throw std::runtime_error("a step was refused");
  return report;
}

void CaseRun::steps(int count) {
  for (int k = 0; k < count; ++k) step();
}

void CaseRun::set_state(const std::vector<Vec3d>& positions, const std::vector<Vec3d>& velocities) {
  // An older state would let the second-order integrator see a jump.
  Snapshot state = simulator_->snapshot();
  state.x1 = positions;
  state.v = velocities;
  state.v.resize(positions.size());
  state.past.forget();
  simulator_->restore(state);
}

void CaseRun::relax(double dt_first, double dt_last, double tolerance, int limit) {
  // Each step is one Newton iteration, damped by mass/dt².
  const Parameters before_all = parameters();
  Parameters p = before_all;
  p.step.time_step = dt_first;
  p.implicit.newton_iterations = 1;
  for (int k = 0; k < limit; ++k) {
    simulator_->set_parameters(p);
    const std::vector<Vec3d> before = positions();
    step();
    const std::vector<Vec3d> after = positions();
    double moved = 0;

    // The motion is taken out, so that the next step starts at rest.
    for (std::size_t v = 0; v < after.size(); ++v)
      moved = std::max(moved, norm(after[v] - before[v]));
    set_state(after, {});
    if (p.step.time_step >= dt_last && moved < tolerance) return set_parameters(before_all);
    p.step.time_step = std::min(1.2 * p.step.time_step, dt_last);
  }

  set_parameters(before_all);
  require(false, "at rest after " + std::to_string(limit) + " steps");
}

void CaseRun::add(Comparison comparison) {
  if (!comparison.passed()) {
    char text[160];
    std::snprintf(text, sizeof text, ": %.6g against %.6g, error %.2e, target %.2e",
                  comparison.measured, comparison.reference, comparison.error, comparison.target);
    result_.failures.push_back(comparison.what + text);
  }
  result_.comparisons.push_back(std::move(comparison));
}

void CaseRun::compare(const std::string& what, double reference, double measured, double target) {
  add({.what = what,
       .reference = reference,
       .measured = measured,
       .error = std::fabs(measured / reference - 1),
       .target = target});
}

void CaseRun::compare_absolute(const std::string& what, double reference, double measured,
                               double target) {
  add({.what = what,
       .reference = reference,
       .measured = measured,
       .error = std::fabs(measured - reference),
       .target = target,
       .absolute = true});
}

void CaseRun::bound(const std::string& what, double measured, double target) {
  compare_absolute(what, 0, measured, target);
}

void CaseRun::require(bool holds, const std::string& what) {
  note_failure(result_.failures, holds, what);
}

std::string number(double value) {
  char text[24];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

bool runs_on(const Case& test, Build& build) {
  if (!test.precise) return true;
  if (build == Build::cuda32) return false;
  build = Build::cpu64;
  return true;
}

CaseResult run_case(const Case& test, const Settings& settings) {
  CaseRun run(settings);
  return result_of(test, run);
}

}  // namespace icloth::validation
