// One case of the stability suite while it runs: steps its simulator, checks every state exactly,
// adds up the figures and holds the result against what is required.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth::stability {

struct Settings {
  Build build = Build::cpu32;
  bool brief = false;        ///< shortest form, for tests that run at every change
  double soak_seconds = 60;  ///< simulated, of the random dragging [s]
  int threads = 0;           ///< of the CPU builds, put back by the case that changes it; 0: all
  std::string frames;        ///< folder that exists, for some of the checked states; empty: none
};

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
  std::vector<std::string> failures;  ///< what was required and is not so
  std::string note;                   ///< one line about what was seen

  bool passed() const { return failures.empty(); }
};

class CaseRun {
 public:
  /// `name`: begins the names of the exported states.
  explicit CaseRun(const Settings& settings, std::string name = "case")
      : settings_(settings), name_(std::move(name)) {}

  const Settings& settings() const { return settings_; }
  bool brief() const { return settings_.brief; }

  /// Makes the simulator of a scene whose start state must be free of intersections. The one
  /// before is dropped, the figures go on.
  Simulator& start(std::shared_ptr<const Scene> scene);
  /// Same velocity for all vertices of a cloth.
  void throw_cloth(std::size_t cloth, Vec3d velocity);
  Simulator& simulator() { return *simulator_; }

  /// From now on only every k-th accepted state is checked exactly.
  void check_every(int k) { check_every_ = k; }
  /// Refused steps are part of what is required; they must name their pairs.
  void allow_refusals() { refusals_allowed_ = true; }

  StepReport step(std::span<const InputEvent> events = {});
  /// Steps until the end or the first refused step; false then.
  bool steps(int count);
  /// As many steps as make up a time [s].
  bool run_for(double seconds);

  void require(bool holds, const std::string& what);
  /// Requires that making a simulator or loading is refused with all these words in the message.
  void require_input_error(const std::function<void()>& load,
                           const std::vector<std::string>& words);
  void note(const std::string& text);

  const CaseResult& figures() const { return result_; }
  std::vector<Vec3d> positions() const { return simulator_->snapshot().positions; }

  /// Checks what holds for all cases and hands out the figures.
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

struct Case {
  const char* name;
  const char* required;  ///< behaviour, one line
  void (*run)(CaseRun&);
};

/// All cases, in the order of the table.
std::span<const Case> cases();

/// Runs one; anything thrown is a failure.
CaseResult run_case(const Case& test, const Settings& settings);

}  // namespace icloth::stability
