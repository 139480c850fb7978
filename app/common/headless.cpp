#include "app/common/headless.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "app/common/element_names.h"
#include "app/common/machine.h"
#include "app/common/progress.h"
#include "sim/files/error.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {
namespace {

constexpr std::size_t kShownPairs = 10;

/// Tells why a step was refused, and the first of its offending pairs.
void print_refusal(const HeadlessJob& job, const StepReport& report) {
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

  // The first pairs show the place; a tangle may have thousands.
  for (std::size_t i = 0; i < std::min(report.offending.size(), kShownPairs); ++i)
    std::fprintf(stderr, "  %s\n", names.pair(report.offending[i]).c_str());
  if (report.offending.size() > kShownPairs)
    std::fprintf(stderr, "  … and %zu more\n", report.offending.size() - kShownPairs);
}

/// Lets the clock go on over a refused step, and says what that did to the state.
void pass_over(Simulator& simulator) {
  simulator.pass_over();
  std::set<Index> let_go;
  for (const LetGo& entry : simulator.snapshot().let_go) let_go.insert(entry.vertex);
  std::fprintf(stderr,
               "icloth: went on to %g s with the cloth at rest: %zu vertices are let go from "
               "bodies, %zu pairs of faces intersect\n",
               simulator.time(), let_go.size(), count_penetrations(simulator));
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
  for (const auto& [name, value] : input.parameters)
    set_parameter(parameters, *find_parameter(name), value);
  simulator.set_parameters(parameters);
}

}  // namespace

void print_notes(const SceneOrigin& origin) {
  for (const std::string& note : origin.notes)
    std::fprintf(stderr, "icloth: note: %s\n", one_line(note).c_str());
}

std::size_t count_penetrations(const Simulator& simulator) {
  const Scene& scene = simulator.scene();
  const Snapshot state = simulator.snapshot();
  const SceneFaces soup = scene_faces(scene);
  return find_intersections(state.x1, soup.faces, soup.group).size();
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
  ScriptedInput script(*job.scene);
  if (job.watch) job.watch(*simulator, nullptr);

  Progress progress(job.scene->name, job.steps, job.quiet);

  // Each step takes its input, and its report goes to the statistics and to the caller.
  for (long step = 0; step < job.steps; ++step) {
    Recording::Step input = next_input(job, script, step, *simulator);
    apply_parameters(*simulator, input);
    const StepReport report = simulator->step(input.events);
    if (job.pass_over && !report.accepted) input.passed_over = true;

    // A refused step is reported, and ends the run or is passed over.
    if (!report.accepted) {
      progress.finish();
      print_refusal(job, report);
      result.refused.push_back(report);
      if (input.passed_over) pass_over(*simulator);
    }
    if (job.record) job.record->steps.push_back(input);
    result.statistics.add(report);
    if (job.watch) job.watch(*simulator, &report);
    if (!report.accepted && job.stop_on_failure) break;
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
