#include "app/cli/commands/replay.h"

#include <cinttypes>
#include <cstdio>

#include "app/common/dressing_progress.h"
#include "app/common/headless.h"
#include "app/common/options.h"
#include "app/common/recording_file.h"

namespace icloth {

int run_replay(const ReplayOptions& options) {
  // The recording says which scene to run, on which build.
  const Recording recording = load_recording(options.recording);
  HeadlessJob job;
  SceneLimits limits;
  limits.allow_outside = options.allow_outside;
  job.scene =
      open_scene_showing(recording.scene, recording.overrides, job.origin, options.quiet, limits);
  check_recording(recording, *job.scene, options.recording);

  job.build = recorded_build(recording);

  // Another device may be asked for; the precision stays that of the recording.
  if (!options.device.empty() || job.build == Build::cuda32) {
    SimulationOptions where;
    where.device = options.device.empty() ? "cuda" : options.device;
    if (job.build == Build::cpu64) where.precision = "f64";
    job.build = choose_build(where);
  }

  // The recorded hands met the same refusals, so the run goes on after them.
  job.steps = static_cast<long>(recording.steps.size());
  job.input = &recording;
  job.stop_on_failure = false;
  job.quiet = options.quiet;

  set_thread_count(options.threads);
  StatisticsFile stats(options.stats_file);
  job.watch = [&](const Simulator&, const StepReport* report, bool) {
    if (report) stats.add(*report);
  };

  const HeadlessResult result = run_headless(job);
  if (result.start_refused) return result.start_exit_code;
  stats.finish(result.statistics);
  if (!options.quiet)
    std::fputs(result.statistics.table(result.penetrations, result.state_hash).c_str(), stdout);

  // Equal input gives equal bits, so any other final state is a failure.
  if (result.state_hash != recording.final_hash) {
    std::fprintf(stderr,
                 "icloth: %s: final state %016" PRIx64 ", recorded was %016" PRIx64 " (%s)\n",
                 options.recording.c_str(), result.state_hash, recording.final_hash,
                 recording.build.c_str());
    return 1;
  }
  if (!options.quiet) std::puts("final state as recorded");
  return result.clean() ? 0 : 1;
}

}  // namespace icloth
