// One case of the validation suite while it runs. It steps its simulator and compares measured
// quantities with references that do not come from the simulation.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth::validation {

/// The settings of a run of the suite.
struct Settings {
  Build build = Build::cpu32;  ///< of the cases that do not ask for double precision
  bool brief = false;          ///< fewest parameter values, for tests that run at every change
};

/// One line of the table.
struct Comparison {
  std::string what;
  double reference = 0, measured = 0;
  double error = 0;   ///< as compared with target, relative unless `absolute`
  double target = 0;  ///< largest error that is accepted
  bool absolute = false;

  bool passed() const { return error <= target; }
};

/// The comparisons of a case and its failures.
struct CaseResult {
  std::vector<Comparison> comparisons;
  std::vector<std::string> failures;  ///< requirements that do not hold, comparisons included
  std::int64_t steps = 0;
  double seconds = 0;  ///< of wall time

  bool passed() const { return failures.empty(); }
};

/// Runs the steps of a case. A case is a function that takes one of these.
class CaseRun {
 public:
  explicit CaseRun(const Settings& settings) : settings_(settings) {}

  bool brief() const { return settings_.brief; }

  /// Makes the simulator of a scene, in place of the one before.
  Simulator& start(std::shared_ptr<const Scene> scene);
  Simulator& simulator() { return *simulator_; }

  /// Makes one step; a refused one ends the case.
  StepReport step();
  void steps(int count);
  Parameters parameters() const { return simulator_->parameters(); }
  void set_parameters(const Parameters& parameters) { simulator_->set_parameters(parameters); }

  std::vector<Vec3d> positions() const { return simulator_->snapshot().x1; }
  /// Sets another state at the same time; velocities may be empty for none.
  void set_state(const std::vector<Vec3d>& positions, const std::vector<Vec3d>& velocities);

  /// Relaxes the cloths to rest without contacts, by steps of growing length that each start from
  /// velocity 0 (a Newton iteration damped by mass/dt²). It ends when the largest displacement of a
  /// step of at least `dt_last` falls below `tolerance` [m]. Not getting there within `limit` steps
  /// is a failure.
  void relax(double dt_first, double dt_last, double tolerance, int limit);

  /// Requires |measured / reference − 1| ≤ target.
  void compare(const std::string& what, double reference, double measured, double target);
  /// Requires |measured − reference| ≤ target.
  void compare_absolute(const std::string& what, double reference, double measured, double target);
  /// Requires |measured| ≤ target, with 0 as the reference.
  void bound(const std::string& what, double measured, double target);
  void require(bool holds, const std::string& what);

  /// Returns the result.
  CaseResult finish() { return result_; }

 private:
  void add(Comparison comparison);

  Settings settings_;
  std::unique_ptr<Simulator> simulator_;
  CaseResult result_;
};

/// One row of the suite.
struct Case {
  const char* name;
  const char* source;  ///< origin of the reference, one line
  bool precise;        ///< needs the double precision build
  void (*run)(CaseRun&);
};

/// A number of a case's name, as short as it can be written.
std::string number(double value);

/// All cases, in the order of the table.
std::span<const Case> cases();

/// Sets `build` to the build that a case runs on when that one is asked for. Returns false for a
/// GPU where the case needs doubles.
bool runs_on(const Case& test, Build& build);

/// Runs one case; anything thrown is a failure.
CaseResult run_case(const Case& test, const Settings& settings);

}  // namespace icloth::validation
