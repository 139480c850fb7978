#include "app/common/headless.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>

#include "app/common/element_names.h"
#include "app/common/interrupt.h"
#include "app/common/machine.h"
#include "app/common/progress.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {
namespace {

constexpr std::size_t kShownPairs = 10;

/// Lists the first pairs of a refused step to show the place; a tangle may have thousands.
void print_offending(const ElementNames& names, const StepReport& report) {
  for (std::size_t i = 0; i < std::min(report.offending.size(), kShownPairs); ++i)
    std::fprintf(stderr, "  %s\n", names.pair(report.offending[i]).c_str());
  if (report.offending.size() > kShownPairs)
    std::fprintf(stderr, "  … and %zu more\n", report.offending.size() - kShownPairs);
}

/// Tells that the scene cannot start, since the first step does not see its layers apart.
void print_close_start(const HeadlessJob& job, const StepReport& report) {
  std::fprintf(stderr, "icloth: scene %s starts with %lld pairs of elements that are too close:\n",
               in_quotes(job.scene->name).c_str(), static_cast<long long>(report.impacts_left));
  print_offending(ElementNames(*job.scene, job.origin.layouts), report);
  std::fprintf(stderr, "  %s\n", kTooCloseForSingle);
}

/// Tells why a step was refused, and the first of its offending pairs.
void print_refusal(const HeadlessJob& job, const StepReport& report, bool too_close) {
  const ElementNames names(*job.scene, job.origin.layouts);

  // The reason names what the user can change, as far as the report tells it.
  std::string reason = pins_in_the_way(*job.scene, names, report);
  if (!reason.empty())
    reason += ", ";
  else if (!report.finite)
    reason = "the state was not finite, ";
  else if (report.no_room)
    reason = "bodies leave the cloth no room, ";
  std::fprintf(stderr, "icloth: step %lld at %g s was refused: %s%lld impacts left\n",
               static_cast<long long>(report.step), report.time, reason.c_str(),
               static_cast<long long>(report.impacts_left));

  print_offending(names, report);
  if (too_close) std::fprintf(stderr, "  %s\n", kTooCloseForSingle);
}

/// The input of one step, from the recording where there is one, else from the scene's script.
Recording::Step next_input(const HeadlessJob& job, ScriptedInput& script, long step,
                           const Simulator& simulator) {
  if (!job.input)
    return {script.events(simulator.time(), simulator.parameters().step.time_step), {}, false};
  const auto index = static_cast<std::size_t>(step);
  return index < job.input->steps.size() ? job.input->steps[index] : Recording::Step{};
}

/// Applies the changes of parameters that the recording holds.
void apply_parameters(Simulator& simulator, const Recording::Step& input) {
  if (input.parameters.empty()) return;
  Parameters parameters = simulator.parameters();
  apply_changes(input, parameters);
  simulator.set_parameters(parameters);
}

void print_notes(std::span<const std::string> notes) {
  for (const std::string& note : notes)
    std::fprintf(stderr, "icloth: note: %s\n", one_line(note).c_str());
}

/// Brings a simulator at the start, and the script of its scene, to the state of a checkpoint.
void go_on_from(const Checkpoint& checkpoint, const std::string& file, Simulator& simulator,
                ScriptedInput& script) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(shown_path(file) + ": " + what);
  };
  if (checkpoint.recording.build != build_name(simulator.build()))
    refuse("made by the build " + checkpoint.recording.build + ", expected " +
           std::string(build_name(simulator.build())) + " (--device, --precision)");
  if (checkpoint.start_hash != simulator.state_hash())
    refuse("made of a scene with another start state than " + in_quotes(simulator.scene().name));

  // What was changed on the way holds on, and so does what hands have hold of.
  for (const Recording::Step& step : checkpoint.recording.steps) apply_parameters(simulator, step);
  try {
    simulator.restore(checkpoint.state);
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  if (simulator.state_hash() != checkpoint.recording.final_hash ||
      simulator.step_index() != checkpoint.steps())
    refuse("the state is not that after its " + std::to_string(checkpoint.steps()) + " steps");
  for (const HandleState& handle : simulator.handles()) script.go_on_holding(handle.id);
}

/// Writes the state, and the input that led to it.
void write_checkpoint(const HeadlessJob& job, const Simulator& simulator,
                      std::uint64_t start_hash) {
  Checkpoint checkpoint{*job.record, start_hash, simulator.snapshot()};
  checkpoint.recording.final_hash = simulator.state_hash();
  save_checkpoint(checkpoint, job.checkpoint_file);
}

/// Tests a state on the way exactly, and says where its faces intersect.
void check_state(const Simulator& simulator, Progress& progress, HeadlessResult& result) {
  const std::size_t pairs = count_penetrations(simulator);
  ++result.states_checked;
  if (pairs == 0) return;
  ++result.states_penetrating;
  progress.finish();
  std::fprintf(stderr, "icloth: after step %lld at %g s %zu pairs of faces intersect\n",
               static_cast<long long>(simulator.step_index()), simulator.time(), pairs);
}

}  // namespace

void apply_changes(const Recording::Step& step, Parameters& parameters) {
  for (const auto& [name, value] : step.parameters)
    set_parameter(parameters, *find_parameter(name), value);
}

void print_notes(const SceneOrigin& origin) { print_notes(origin.notes); }

std::size_t count_penetrations(const Simulator& simulator) {
  const Scene& scene = simulator.sewn_scene();
  const Snapshot state = simulator.snapshot();
  const SceneFaces soup = scene_faces(scene);
  return find_intersections(state.x1, soup.faces, soup.group).size();
}

std::string pass_over_step(Simulator& simulator) {
  simulator.pass_over();
  std::set<Index> let_go;
  for (const LetGo& entry : simulator.snapshot().let_go) let_go.insert(entry.vertex);
  char text[160];
  std::snprintf(text, sizeof text,
                "went on to %g s with the cloth at rest: %zu vertices are let go from bodies, "
                "%zu pairs of faces intersect",
                simulator.time(), let_go.size(), count_penetrations(simulator));
  return text;
}

bool is_too_close(Simulator& simulator, const StepReport& report) {
  return !report.accepted && report.finite && simulator.build() != Build::cpu64 &&
         !simulator.contacts_at_rest().empty();
}

HeadlessResult run_headless(const HeadlessJob& job) {
  HeadlessResult result;
  if (!job.quiet) print_notes(job.origin);

  // A start state that intersects is refused.
  result.start_exit_code =
      report_start_intersections(*job.scene, job.build != Build::cpu64, job.origin.layouts);
  result.start_refused = result.start_exit_code != 0;
  if (result.start_refused) return result;

  const std::unique_ptr<Simulator> simulator = make_simulator(job.build, job.scene);
  simulator->report_energies(job.energies);
  ScriptedInput script(*job.scene);

  // A run that is resumed has made its first steps already.
  long first = 0;
  const std::uint64_t start_hash = simulator->state_hash();
  if (job.resume) {
    go_on_from(*job.resume, job.resume_file, *simulator, script);
    first = static_cast<long>(job.resume->steps());
    if (job.record) job.record->steps = job.resume->recording.steps;
  }
  if (job.watch) job.watch(*simulator, nullptr, first >= job.steps);

  std::optional<InterruptWatch> interrupts;
  if (job.interruptible) interrupts.emplace();
  Progress progress(job.scene->name, job.steps, job.quiet);

  // Each step takes its input, and its report goes to the statistics and to the caller.
  for (long step = first; step < job.steps && !result.interrupted; ++step) {
    Recording::Step input = next_input(job, script, step, *simulator);
    apply_parameters(*simulator, input);
    const StepReport report = simulator->step(input.events);
    if (job.pass_over && !report.accepted) input.passed_over = true;

    // Layers that the numbers of the build do not tell apart are a fault of the start state.
    const bool too_close = is_too_close(*simulator, report);
    if (too_close && step == 0 && job.stop_on_failure) {
      progress.finish();
      print_close_start(job, report);
      result.start_contacts = report.offending;
      result.start_refused = true;
      result.start_exit_code = 1;
      return result;
    }

    // What became of seams is said as it happens.
    if (!job.quiet && !report.notes.empty()) {
      progress.finish();
      print_notes(report.notes);
    }

    // A refused step is reported, and ends the run or is passed over.
    if (!report.accepted) {
      progress.finish();
      print_refusal(job, report, too_close);
      result.refused.push_back(report);
      if (input.passed_over)
        std::fprintf(stderr, "icloth: %s\n", pass_over_step(*simulator).c_str());
    }
    if (job.record) job.record->steps.push_back(input);
    result.statistics.add(report);

    // What was made is written before the next step, and the end of the run is known by then.
    const bool stops = !report.accepted && job.stop_on_failure;
    if (interrupts) result.interrupted = interrupts->noted();
    const bool last = stops || result.interrupted || step + 1 == job.steps;
    if (job.watch) job.watch(*simulator, &report, last);
    if (!job.checkpoint_file.empty() && !stops && (last || (step + 1) % job.checkpoint_every == 0))
      write_checkpoint(job, *simulator, start_hash);
    if (stops) break;
    if (job.check_every > 0 && !last && (step + 1) % job.check_every == 0)
      check_state(*simulator, progress, result);
    progress.update(step + 1);
  }
  progress.finish();

  // The final state is checked exactly, and named by its hash.
  const ComputeDevice device = compute_device(job.build);
  result.statistics.set_device(device.name, device.copy_bandwidth);
  result.penetrations = count_penetrations(*simulator);
  result.state_hash = simulator->state_hash();
  if (job.record) job.record->final_hash = result.state_hash;
  return result;
}

}  // namespace icloth
