// Stepping a scene without a window, as run, replay, render and bench do it.
#pragma once

#include <functional>
#include <memory>

#include "app/common/run_statistics.h"
#include "sim/scene/input.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "sim/state/checkpoint.h"

namespace icloth {

struct HeadlessJob {
  std::shared_ptr<const Scene> scene;
  SceneOrigin origin;  ///< of the scene: its notes are printed, its numbers used in messages
  Build build = Build::cpu32;
  long steps = 0;
  const Recording* input = nullptr;  ///< replaces the scene's scripted grabs; null: the script
  Recording* record = nullptr;       ///< its steps and hash are filled; null: nothing is kept
  bool stop_on_failure = true;
  /// The clock goes on over refused steps (Simulator::pass_over); those of a recording that did so
  /// are passed over in any case.
  bool pass_over = false;
  bool energies = true;        ///< reports have energies (Simulator::report_energies)
  bool quiet = false;          ///< no progress line
  bool interruptible = false;  ///< Ctrl-C ends it after the step that is being made

  /// Goes on from there, with the first of the `steps` made already; null: from the start.
  const Checkpoint* resume = nullptr;
  std::string resume_file;      ///< its name in messages
  std::string checkpoint_file;  ///< written every so many steps and at the end; empty: not
  long checkpoint_every = 100;

  /// Each such step the state is tested for faces that intersect, exactly; 0: only at the end.
  long check_every = 0;

  /// Called with the start state (null report) and after every step; `last`: no step follows.
  std::function<void(const Simulator&, const StepReport*, bool last)> watch;
};

struct HeadlessResult {
  RunStatistics statistics;
  std::vector<StepReport> refused;            ///< steps that were not accepted, with their pairs
  std::size_t penetrations = 0;               ///< pairs of faces that intersect in the final state
  std::size_t states_checked = 0;             ///< on the way, without the final state
  std::size_t states_penetrating = 0;         ///< of these, with faces that intersect
  std::uint64_t state_hash = 0;               ///< of the final state
  bool start_refused = false;                 ///< the start state intersects; nothing was simulated
  std::vector<OffendingPair> start_contacts;  ///< of layers that are too close for the build
  const char* interrupted = nullptr;          ///< name of the signal that ended it
  int start_exit_code = 0;  ///< of a refused start: 1, or 2 where only the mesh is at fault

  bool clean() const {
    return refused.empty() && penetrations == 0 && states_penetrating == 0 && !start_refused &&
           !interrupted;
  }
};

/// Checks the start state, steps, and checks the final state exactly. Start intersections and
/// refused steps are printed to stderr. Throws InputError where a checkpoint is of another scene.
HeadlessResult run_headless(const HeadlessJob& job);

/// Applies the changes of parameters that were recorded before a step.
void apply_changes(const Recording::Step& step, Parameters& parameters);

/// Makes the simulator pass over the step that it just refused, and says what that did to the
/// state: "went on to 0.3 s with the cloth at rest: …".
std::string pass_over_step(Simulator& simulator);

/// Whether a step was refused because surfaces are closer than the numbers of the build resolve:
/// the collision test does not see them apart even at rest. Never in double precision.
bool is_too_close(Simulator& simulator, const StepReport& report);

/// Prints what the loader has to say about the input of a scene to stderr, a line each.
void print_notes(const SceneOrigin& origin);

/// Pairs of intersecting faces of a simulator's present state.
std::size_t count_penetrations(const Simulator& simulator);

}  // namespace icloth
