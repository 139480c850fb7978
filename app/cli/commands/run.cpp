#include "app/cli/commands/run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "app/cli/commands/garment_file.h"
#include "app/common/dressing_progress.h"
#include "app/common/frame_formats.h"
#include "app/common/headless.h"
#include "kernels/parallel/profile.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/frame_export.h"
#include "sim/files/text.h"
#include "sim/scene/scene_meshes.h"

namespace icloth {
namespace {

/// Refuses outputs that cannot work before anything takes time.
void check(const RunOptions& options) {
  if (!options.exports.empty() && options.out.empty())
    throw InputError("--export " + options.exports.front() + ": expected --out DIR with it");
  require_folder("--record", options.record_file);
  require_folder("--checkpoint", options.checkpoint_file);
}

/// The command that repeats a run up to a failed step.
std::string repeat_command(const RunOptions& options, Build build, std::int64_t steps) {
  std::string text = "icloth run " + command_arguments(options.simulation, build);
  if (!options.input_file.empty()) text += " --input " + options.input_file;
  return text + " --steps " + std::to_string(steps);
}

/// Prints the primitives by falling time, and the bandwidth of the linear solver.
void print_profile(const RunStatistics& statistics) {
  std::vector<ProfileRow> rows = profile_rows();
  std::sort(rows.begin(), rows.end(),
            [](const ProfileRow& a, const ProfileRow& b) { return a.ms > b.ms; });

  // The solver has moved these bytes at least, over all steps.
  double solver_bytes = 0;
  for (const StepReport& report : statistics.reports()) solver_bytes += report.cg_bytes;
  const double steps = std::max<double>(1, static_cast<double>(statistics.steps()));
  std::printf("%-32s %12s %12s\n", "primitive", "calls/step", "ms/step");

  for (const ProfileRow& row : rows) {
    std::printf("%-32s %12.1f %12.4f\n", row.name.c_str(), static_cast<double>(row.calls) / steps,
                row.ms / steps);
    if (row.name == "implicit.solve" && row.ms > 0)
      std::printf("%-32s %25.1f GB/s\n", "  moves at least", solver_bytes / row.ms / 1e6);
  }
}

/// Chooses scene, device and length of a run, and the recording that moves its hands.
HeadlessJob make_job(const RunOptions& options, Recording& input) {
  const SimulationOptions& common = options.simulation;
  HeadlessJob job;
  job.scene = open_scene_showing(common.scene, scene_overrides(common), job.origin, common.quiet,
                                 scene_limits(common));
  if (!options.input_file.empty()) {
    input = load_recording(options.input_file);
    check_recording(input, *job.scene, options.input_file);
    job.input = &input;
  }

  // Without another length the run is as long as its input.
  job.build = choose_build(common);
  const bool whole_input = job.input && common.steps < 0 && common.time < 0;
  job.steps = whole_input ? static_cast<long>(input.steps.size()) : step_count(common, *job.scene);
  job.stop_on_failure = options.on_failure == "stop";
  job.pass_over = !job.stop_on_failure;
  job.energies = !options.stats_file.empty();
  job.quiet = common.quiet;
  return job;
}

/// A recording of what a run is given; the run adds its steps and its end.
Recording begin_recording(const SimulationOptions& common, Build build) {
  Recording record;
  record.scene = common.scene;
  record.build = build_name(build);
  record.overrides = scene_overrides(common);
  return record;
}

/// The formats that --export names; OBJ where it names none.
std::vector<FrameFormat> export_formats(const RunOptions& options) {
  return options.exports.empty() ? std::vector{FrameFormat::obj} : frame_formats(options.exports);
}

/// The files that are written while a run goes.
class RunFiles {
 public:
  /// A run that goes on after `steps` steps adds to the files of the one before.
  RunFiles(const RunOptions& options, const Scene& scene, std::int64_t steps)
      : stats_(options.stats_file, steps),
        garments_(options.garments_file, scene),
        frames_(options.out, options.every, export_formats(options), steps),
        step_(steps) {}

  /// Takes the start state, without a report, or the state after a step.
  void add(const HeadlessJob& job, const Simulator& simulator, const StepReport* report,
           bool last) {
    if (report) stats_.add(*report);

    // A refused step that ends the run leaves the state of the step before as the last one.
    const bool stopped = report && !report->accepted && job.stop_on_failure;
    if (report && !stopped) ++step_;
    if (!stopped) garments_.add(simulator, step_);
    if (!frames_.wants(step_, last)) return;
    simulator.positions(positions_);
    frames_.write(named_meshes(*job.scene, positions_, job.origin.layouts).meshes, step_,
                  simulator.time(), last);
  }

  std::int64_t steps() const { return step_; }
  void finish(const RunStatistics& statistics) { stats_.finish(statistics); }
  std::string garment_summary() const { return garments_.summary(); }

 private:
  StatisticsFile stats_;
  GarmentFile garments_;
  FrameExport frames_;
  std::vector<Vec3f> positions_;
  std::int64_t step_;
};

/// Prints what the options ask for about the end of a run. A failure tells how to repeat it.
/// `steps` is the number of those that the state is after.
void print_end(const RunOptions& options, Build build, std::int64_t steps,
               const HeadlessResult& result) {
  if (!options.simulation.quiet)
    std::fputs(result.statistics.table(result.penetrations, result.state_hash).c_str(), stdout);
  if (options.check_every > 0 && !options.simulation.quiet)
    std::printf("%-22s %12zu   of them with penetrations: %zu\n", "states checked",
                result.states_checked, result.states_penetrating);
  if (options.profile) print_profile(result.statistics);
  if (result.interrupted)
    std::fprintf(stderr, "icloth: ended by %s after %lld steps; what was asked for is written\n",
                 result.interrupted, static_cast<long long>(steps));
  if (!result.refused.empty())
    std::fprintf(stderr, "icloth: repeat with: %s\n",
                 repeat_command(options, build, result.refused.front().step + 1).c_str());
}

}  // namespace

int run_run(const RunOptions& options) {
  check(options);
  Recording input;
  HeadlessJob job = make_job(options, input);
  Recording record = begin_recording(options.simulation, job.build);
  job.interruptible = true;

  // A checkpoint holds the input up to it, so it needs the recording as well.
  if (!options.record_file.empty() || !options.checkpoint_file.empty()) job.record = &record;
  job.checkpoint_file = options.checkpoint_file;
  job.checkpoint_every = options.checkpoint_every;
  job.check_every = options.check_every;
  std::optional<Checkpoint> resumed;
  if (!options.resume_file.empty()) {
    resumed = load_checkpoint(options.resume_file);
    job.resume = &*resumed;
    job.resume_file = options.resume_file;
  }

  // Statistics and frames are written while the run goes.
  set_thread_count(options.simulation.threads);

  // Those of a run that is resumed are touched only when its checkpoint was found to fit.
  std::optional<RunFiles> files;
  if (!resumed) files.emplace(options, *job.scene, 0);
  job.watch = [&](const Simulator& simulator, const StepReport* report, bool last) {
    if (!files) files.emplace(options, *job.scene, resumed->steps());
    files->add(job, simulator, report, last);
  };
  profile_enable(options.profile);
  const HeadlessResult result = run_headless(job);
  profile_enable(false);
  if (result.start_refused) return result.start_exit_code;

  // The rest is written at its end.
  files->finish(result.statistics);
  if (!options.record_file.empty()) save_recording(record, options.record_file);
  print_end(options, job.build, files->steps(), result);
  if (!options.simulation.quiet) std::fputs(files->garment_summary().c_str(), stdout);
  return result.clean() ? 0 : 1;
}

}  // namespace icloth
