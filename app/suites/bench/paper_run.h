// Runs a scene of the paper up to its stretches, and measures every way of handling collisions
// from the same states.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/suites/bench/bench_options.h"
#include "app/suites/bench/paper_modes.h"
#include "app/suites/bench/paper_progress.h"
#include "app/suites/bench/paper_rows.h"
#include "app/suites/bench/paper_store.h"
#include "sim/simulator.h"
#include "sim/state/checkpoint.h"

namespace icloth {

/// What all measurements of a report share.
struct PaperContext {
  Build build = Build::cpu32;
  int threads = 1;
  double scale = 1;     ///< of the number of triangles
  std::string machine;  ///< the part of the keys that names program, device and threads
  PaperStore& store;
  PaperProgress& progress;
};

/// Triangles of a scene at a share of the number that the paper gives it.
int triangles_of(double scale, const PaperScene& scene);

/// Name of the run that leads to a stretch, and of the measurement of one way.
std::string run_name(const PaperScene& scene, const Stretch& stretch);
std::string measurement_name(const PaperScene& scene, const Stretch& stretch,
                             const std::string& mode);

/// All that a result of a stretch depends on: program, machine, the file of the scene, its size.
std::string key_of(const PaperContext& context, const PaperScene& scene, const Stretch& stretch);
/// The changes of the scene by which its run to a stretch starts, as --set takes them.
std::vector<std::string> overrides_of(double scale, const PaperScene& scene,
                                      const Stretch& stretch);

/// In place of a mode: the bandwidth of the memory before and after a stretch.
inline const std::string kMachine = "machine";

/// The stretches of a scene that one run reaches: those with the same start of the clip.
class PaperRun {
 public:
  PaperRun(const PaperContext& context, const PaperScene& scene, std::vector<Stretch> stretches);

  /// Adds the work to the progress.
  void plan() const;
  /// Measures what the store does not have. Throws PaperInterrupted, with the run saved.
  void measure();

 private:
  using Json = PaperStore::Json;

  std::string key() const { return key_of(context_, scene_, stretches_[0]); }
  double step_cost() const;
  double lead_steps() const;
  bool all_measured(const Stretch& stretch) const;
  void drop_measured() const;
  bool has_run() const;
  std::string stretch_path(const Stretch& stretch) const;

  void open();
  /// Takes up the saved run, or begins at the start.
  void resume();
  void save(const std::string& path) const;
  void save_run();
  /// A state that was saved by this run after so many steps; none where it cannot be used.
  std::optional<Checkpoint> load(const std::string& path, std::int64_t steps);

  void advance_to(long step);
  void step_once();
  double bandwidth_now() const;
  void measure_stretch(const Stretch& stretch);
  bool measure_passed(const Stretch& stretch);
  std::optional<Json> measure_modes(const Stretch& stretch, const Snapshot& start);
  Json measure_mode(const Stretch& stretch, const PaperMode& mode, const Snapshot& start);

  const PaperContext& context_;
  const PaperScene& scene_;
  std::vector<Stretch> stretches_;

  std::unique_ptr<Simulator> simulator_;  ///< null until it is needed
  Parameters own_;                        ///< the scene's
  std::uint64_t start_hash_ = 0;
  PaperRows rows_;       ///< of the steps of the run so far
  Recording recording_;  ///< the same steps
};

/// All runs of a scene, in the order of its stretches.
std::vector<PaperRun> runs_of(const PaperContext& context, const PaperScene& scene);

}  // namespace icloth
