// One case of the validation suite while it runs: steps its simulator and holds measured figures
// against references that do not come from the simulation.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth::validation {

struct Settings {
  Build build = Build::cpu32;  ///< of the cases that do not ask for double precision
  bool brief = false;          ///< fewest parameter values, for tests that run at every change
};

/// One line of the table.
struct Figure {
  std::string what;
  double reference = 0, measured = 0;
  double error = 0;   ///< as compared with target, relative unless `absolute`
  double target = 0;  ///< largest error that is accepted
  bool absolute = false;

  bool passed() const { return error <= target; }
};

struct CaseResult {
  std::vector<Figure> figures;
  std::vector<std::string> failures;  ///< what was required and is not so, figures included
  std::int64_t steps = 0;
  double seconds = 0;  ///< of wall time

  bool passed() const { return failures.empty(); }
};

class CaseRun {
 public:
  explicit CaseRun(const Settings& settings) : settings_(settings) {}

  bool brief() const { return settings_.brief; }

  /// Makes the simulator of a scene, in the place of the one before.
  Simulator& start(std::shared_ptr<const Scene> scene);
  Simulator& simulator() { return *simulator_; }

  /// One step; a refused one ends the case.
  StepReport step();
  void steps(int count);
  Parameters parameters() const { return simulator_->parameters(); }
  void set_parameters(const Parameters& parameters) { simulator_->set_parameters(parameters); }

  std::vector<Vec3d> positions() const { return simulator_->snapshot().positions; }
  /// Another state at the same time; velocities may be empty for none.
  void set_state(const std::vector<Vec3d>& positions, const std::vector<Vec3d>& velocities);

  /// Relaxes the cloths to rest without contacts: steps of growing length, each from velocity 0
  /// (a Newton iteration damped by mass/dt²). Ends when the largest move of a step of at least
  /// `dt_last` falls below `tolerance` [m]; not to get there within `limit` steps is a failure.
  void relax(double dt_first, double dt_last, double tolerance, int limit);

  /// |measured / reference − 1| ≤ target.
  void compare(const std::string& what, double reference, double measured, double target);
  /// |measured − reference| ≤ target.
  void compare_absolute(const std::string& what, double reference, double measured, double target);
  /// |measured| ≤ target, with 0 as the reference.
  void bound(const std::string& what, double measured, double target);
  void require(bool holds, const std::string& what);

  /// Hands out the figures.
  CaseResult finish() { return result_; }

 private:
  void add(Figure figure);

  Settings settings_;
  std::unique_ptr<Simulator> simulator_;
  CaseResult result_;
};

struct Case {
  const char* name;
  const char* source;  ///< where the reference comes from, one line
  bool precise;        ///< needs the double precision build
  void (*run)(CaseRun&);
};

/// A number of a case's name, as short as it goes.
std::string number(double value);

/// All cases, in the order of the table.
std::span<const Case> cases();

/// Build that a case runs on when `build` is asked for; none of a GPU where it needs doubles.
bool runs_on(const Case& test, Build& build);

/// Runs one; anything thrown is a failure.
CaseResult run_case(const Case& test, const Settings& settings);

}  // namespace icloth::validation
