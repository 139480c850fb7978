#include "app/suites/bench/paper.h"

#include <cstdio>

#include "app/common/machine.h"
#include "app/suites/bench/paper_figures.h"
#include "app/suites/bench/paper_sphere.h"
#include "app/suites/bench/suite.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

using Json = PaperStore::Json;

/// The part of the keys that all measurements have: results of another program, device or number of
/// threads are not mixed with these.
std::string machine_key(const PaperContext& context) {
  const std::string program = read_file("/proc/self/exe");
  return program_version() + " " + program_commit() + " " + sum_text(program) + ", " +
         std::string(build_name(context.build)) + " " + compute_device(context.build).name + ", " +
         processor_name() + ", " + std::to_string(context.threads) + " threads";
}

/// A group of comparisons on the simplified Sphere.
struct SphereGroup {
  const char* name;
  SphereSections (*measure)(const SphereSetup&);
  double seconds;  ///< about its time
};
constexpr SphereGroup kSphereGroups[] = {{"simple/responses", measure_responses, 10},
                                         {"simple/tangles", measure_tangles, 40},
                                         {"simple/optimum", measure_optimum, 20},
                                         {"simple/time steps", measure_time_steps, 60}};

/// Measures a group or takes it from the store, and adds it to the report. False where a state with
/// penetrations was accepted.
bool show_sphere_group(const PaperContext& context, const SphereGroup& group, Report* report) {
  const std::string key = context.machine + ", scale " + number_text(context.scale);
  const Json* found = context.store.find(group.name, key);

  // The tables and plots themselves are what is kept.
  if (!found) {
    const SphereSetup setup{context.build, context.scale, [&] { context.progress.check(); }};
    context.progress.advance(0, group.name);
    const SphereSections measured = group.measure(setup);
    Json json = {{"clean", measured.clean}, {"sections", Json::array()}};
    for (const Section& section : measured.sections)
      json["sections"].push_back(section_to_json(section));
    found = &context.store.put(group.name, key, std::move(json));
    context.progress.advance(group.seconds, group.name);
  }
  if (report)
    for (const Json& section : found->at("sections")) report->add(section_from_json(section));
  return found->at("clean");
}

/// Measures all that is chosen and not there yet.
void measure_all(const BenchOptions& options, const PaperContext& context) {
  const std::vector<PaperScene> scenes = scenes_at(context.scale);
  std::vector<PaperRun> runs;
  for (const PaperScene& scene : scenes)
    if (chosen(options, scene.name))
      for (PaperRun& run : runs_of(context, scene)) runs.push_back(std::move(run));

  // All work is planned before any of it begins, so that the time left is that of the whole.
  const bool simple = chosen(options, "simple");
  for (const PaperRun& run : runs) run.plan();
  for (const SphereGroup& group : kSphereGroups)
    if (simple) context.progress.plan(group.seconds);

  for (PaperRun& run : runs) run.measure();
  for (const SphereGroup& group : kSphereGroups)
    if (simple) show_sphere_group(context, group, nullptr);
}

/// Makes the report from what was measured.
bool show_all(const BenchOptions& options, const PaperContext& context, Report& report) {
  PaperResults results{context, {}};
  for (const PaperScene& scene : scenes_at(context.scale))
    if (chosen(options, scene.name)) results.scenes.push_back(scene);
  if (context.scale != 1)
    report.text(
        "The scenes have " + number_text(context.scale) +
        " of the paper's triangles, so that these times are not those of the paper's sizes." +
        (context.scale < kQuickLook
             ? " A quick look leaves out the stretches that take long to reach."
             : ""));

  show_speed(results, report);
  show_single_attempts(results, report);
  show_figures(results, report);
  bool clean = is_clean(results);
  if (chosen(options, "simple"))
    for (const SphereGroup& group : kSphereGroups)
      clean = show_sphere_group(context, group, &report) && clean;
  show_frames(results, report);

  // What was measured when is part of the report.
  if (context.store.reused() > 0)
    report.text(std::to_string(context.store.reused()) +
                " results were measured before this run went on (--continue).");
  for (const std::string& note : context.store.notes()) report.text("Note: " + note);
  return clean;
}

bool has_case(const BenchOptions& options) {
  for (const PaperScene& scene : paper_scenes())
    if (chosen(options, scene.name)) return true;
  return chosen(options, "simple");
}

}  // namespace

int run_paper(const BenchOptions& options) {
  if (!has_case(options)) throw no_such_case(options);
  if (options.go_on && options.out.empty())
    throw InputError("--continue: expected --out FOLDER with it, where the measurements are");
  const Build build = only_build(options);
  Report report = begin_report(options, build);
  PaperStore store(options.out, options.go_on);
  PaperProgress progress(options.quiet);
  PaperContext context{build,         options.threads > 0 ? options.threads : processor_threads(),
                       options.scale, "",
                       store,         progress};
  context.machine = machine_key(context);

  // A signal ends it between two steps; what was measured by then is in the folder.
  try {
    measure_all(options, context);
  } catch (const PaperInterrupted& interrupted) {
    progress.clear();
    const std::string how = options.out.empty() ? " (with --out FOLDER it could go on later)"
                                                : ": 'icloth bench paper --out " + options.out +
                                                      " --continue' with the same options goes on";
    std::fprintf(stderr, "icloth: interrupted by %s%s\n", interrupted.signal, how.c_str());
    return 1;
  }
  progress.clear();

  try {
    const bool clean = show_all(options, context, report);
    finish_report(options, report);
    return clean ? 0 : 1;
  } catch (const Json::exception&) {
    throw InputError(options.out + "/progress.json: expected the measurements of this program");
  }
}

}  // namespace icloth
