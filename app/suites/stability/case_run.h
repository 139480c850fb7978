// One case of the stability suite while it runs. It steps its simulator, checks every state
// exactly, adds up the statistics and compares the result with what is required.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth::stability {

/// The settings of a run of the suite.
struct Settings {
  Build build = Build::cpu32;
  bool brief = false;        ///< shortest form, for tests that run at every change
  double soak_seconds = 60;  ///< simulated, of the random dragging [s]
  int threads = 0;           ///< of the CPU builds, put back by the case that changes it; 0: all
  std::string frames;        ///< folder that exists, for some of the checked states; empty: none
};

/// The statistics of a case and its failures.
struct CaseResult {
  std::int64_t steps = 0, substeps = 0, retries = 0, rounds = 0, impacts = 0;
  std::int64_t refused = 0;       ///< steps that kept the state before them
  std::int64_t states = 0;        ///< accepted states that were checked exactly
  std::int64_t penetrations = 0;  ///< pairs of faces that intersect, over all of them
  double violation = 0;           ///< worst StepReport::zone_violation [m]
  double max_strain = 0;
  double max_speed = 0;               ///< [m/s]
  bool finite = true;                 ///< no accepted state held NaN or infinity
  double seconds = 0;                 ///< of wall time
  std::vector<std::string> failures;  ///< requirements that do not hold
  std::string note;                   ///< one line about the run

  bool passed() const { return failures.empty(); }
};

/// Runs the steps of a case. A case is a function that takes one of these.
class CaseRun {
 public:
  /// `name` begins the names of the exported states.
  explicit CaseRun(const Settings& settings, std::string name = "case")
      : settings_(settings), name_(std::move(name)) {}

  const Settings& settings() const { return settings_; }
  bool brief() const { return settings_.brief; }

  /// Makes the simulator of a scene whose start state must be free of intersections. The one before
  /// is dropped; the statistics go on.
  Simulator& start(std::shared_ptr<const Scene> scene);
  /// Gives all vertices of a cloth the same velocity.
  void throw_cloth(std::size_t cloth, Vec3d velocity);
  Simulator& simulator() { return *simulator_; }

  /// Checks only every k-th accepted state exactly from now on.
  void check_every(int k) { check_every_ = k; }
  /// Allows refused steps, which are part of what is required; they must name their pairs.
  void allow_refusals() { refusals_allowed_ = true; }

  StepReport step(std::span<const InputEvent> events = {});
  /// Steps until the end or the first refused step; returns false in the latter case.
  bool steps(int count);
  /// Makes as many steps as a time [s] takes.
  bool run_for(double seconds);

  void require(bool holds, const std::string& what);
  /// Requires that making a simulator or loading is refused, with all these words in the message.
  void require_input_error(const std::function<void()>& load,
                           const std::vector<std::string>& words);
  void note(const std::string& text);

  const CaseResult& result() const { return result_; }
  std::vector<Vec3d> positions() const { return simulator_->snapshot().x1; }

  /// Checks the requirements that all cases share and returns the result.
  CaseResult finish();

 private:
  void check_state();
  void write_state() const;
  void check_refusal(const Snapshot& before, const StepReport& report);

  Settings settings_;
  std::string name_;
  std::unique_ptr<Simulator> simulator_;
  std::vector<Triangle> faces_;
  std::vector<int> group_;
  int check_every_ = 1;
  bool refusals_allowed_ = false;
  CaseResult result_;
};

/// One row of the suite.
struct Case {
  const char* name;
  const char* required;  ///< behaviour, one line
  void (*run)(CaseRun&);
};

/// All cases, in the order of the table.
std::span<const Case> cases();

/// Runs one case; anything thrown is a failure.
CaseResult run_case(const Case& test, const Settings& settings);

}  // namespace icloth::stability
