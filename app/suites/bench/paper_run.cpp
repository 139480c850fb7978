#include "app/suites/bench/paper_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "app/common/headless.h"
#include "app/common/machine.h"
#include "app/suites/bench/paper_quiet.h"
#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"
#include "sim/garment/open_scene.h"

namespace icloth {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSaveInterval = 60;  // of wall time between saved states of a run [s]
constexpr double kMostSeconds = 150;  // of a measurement; the step in progress is finished
constexpr double kFewestTriangles = 100;
constexpr double kSmallestTimed = 0.01;  // scale

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

int triangles_of(double scale, const PaperScene& scene) {
  return static_cast<int>(std::lround(std::max(scale * scene.triangles, kFewestTriangles)));
}

std::string run_name(const PaperScene& scene, const Stretch& stretch) {
  std::string name(scene.name);
  if (stretch.clip_start >= 0) name += "-from-" + number_text(stretch.clip_start);
  return name;
}

std::string measurement_name(const PaperScene& scene, const Stretch& stretch,
                             const std::string& mode) {
  return run_name(scene, stretch) + "/" + std::to_string(stretch.first) + "/" + mode;
}

std::vector<std::string> overrides_of(double scale, const PaperScene& scene,
                                      const Stretch& stretch) {
  std::vector<std::string> list = {"triangles=" + std::to_string(triangles_of(scale, scene))};
  if (stretch.clip_start >= 0) list.push_back("clip_start=" + number_text(stretch.clip_start));
  return list;
}

std::string key_of(const PaperContext& context, const PaperScene& scene, const Stretch& stretch) {
  const std::string file = assets_folder() + "/scenes/" + std::string(scene.name) + ".json";
  std::string key = context.machine + ", scene " + sum_text(read_file(file));
  for (const std::string& override : overrides_of(context.scale, scene, stretch))
    key += ", " + override;
  return key;
}

std::vector<PaperRun> runs_of(const PaperContext& context, const PaperScene& scene) {
  std::vector<PaperRun> runs;
  std::vector<Stretch> together;
  for (const Stretch& stretch : scene.stretches) {
    if (!together.empty() && together.back().clip_start != stretch.clip_start) {
      runs.emplace_back(context, scene, together);
      together.clear();
    }
    together.push_back(stretch);
  }
  runs.emplace_back(context, scene, together);
  return runs;
}

PaperRun::PaperRun(const PaperContext& context, const PaperScene& scene,
                   std::vector<Stretch> stretches)
    : context_(context), scene_(scene), stretches_(std::move(stretches)) {}

double PaperRun::step_cost() const { return scene_.step_seconds * std::min(context_.scale, 1.0); }

/// Steps of the run outside its stretches.
double PaperRun::lead_steps() const {
  long steps = 0, reached = 0;
  for (const Stretch& stretch : stretches_) {
    steps += stretch.first - reached;
    reached = stretch.end();
  }
  return static_cast<double>(steps);
}

void PaperRun::plan() const {
  double steps = lead_steps();
  for (const Stretch& stretch : stretches_)
    for (const PaperMode& mode : modes_of(scene_, stretch))
      steps += mode.cost * static_cast<double>(mode.steps);
  context_.progress.plan(steps * step_cost());
}

/// Drops the work from the plan that the store saves.
void PaperRun::drop_measured() const {
  double steps =
      std::ranges::all_of(stretches_, [&](auto& s) { return all_measured(s); }) ? lead_steps() : 0;
  for (const Stretch& stretch : stretches_)
    for (const PaperMode& mode : modes_of(scene_, stretch))
      if (context_.store.find(measurement_name(scene_, stretch, mode.name), key()))
        steps += mode.cost * static_cast<double>(mode.steps);
  context_.progress.plan(-steps * step_cost());
}

bool PaperRun::all_measured(const Stretch& stretch) const {
  return std::ranges::all_of(modes_of(scene_, stretch), [&](const PaperMode& mode) {
    return context_.store.find(measurement_name(scene_, stretch, mode.name), key()) != nullptr;
  });
}

/// Whether the store has the steps of the run up to the end of its last stretch.
bool PaperRun::has_run() const {
  const Json* saved = context_.store.find(run_name(scene_, stretches_[0]) + "/run", key());
  return saved && static_cast<long>(rows_of(saved->at("rows"))) >= stretches_.back().end();
}

void PaperRun::measure() {
  drop_measured();
  const auto is_measured = [&](const Stretch& stretch) { return all_measured(stretch); };
  if (has_run() && std::ranges::all_of(stretches_, is_measured)) return;
  open();
  resume();

  for (const Stretch& stretch : stretches_) {
    const bool passed = static_cast<long>(rows_.size()) >= stretch.end();
    if (passed && all_measured(stretch)) continue;
    if (passed && measure_passed(stretch)) continue;

    // Without the state of a stretch that was passed the run begins anew, unless that stretch is
    // measured and its steps alone are missing.
    if (static_cast<long>(rows_.size()) > stretch.first) {
      if (all_measured(stretch)) {
        advance_to(stretch.end());
        save_run();
        continue;
      }
      open();
    }
    advance_to(stretch.first);
    measure_stretch(stretch);
  }
  simulator_.reset();
}

/// Measures what is missing of a stretch that the run has passed, from the state that was saved at
/// its beginning. False where that state cannot be used.
bool PaperRun::measure_passed(const Stretch& stretch) {
  const Snapshot now = simulator_->snapshot();
  const auto checkpoint = load(stretch_path(stretch), stretch.first);
  if (checkpoint) measure_modes(stretch, checkpoint->state);
  simulator_->set_parameters(own_);
  simulator_->restore(now);
  return checkpoint.has_value();
}

std::string PaperRun::stretch_path(const Stretch& stretch) const {
  return context_.store.checkpoint_path(run_name(scene_, stretch) + "-" +
                                        std::to_string(stretch.first));
}

void PaperRun::open() {
  SceneOrigin origin;
  const std::string title(scene_.title);

  // Dressing takes long at the paper's sizes, and ends at a signal as all other work does.
  const DressingWatch watch = [&](const Simulator&, const DressingStatus& status) {
    context_.progress.advance(0, title + ": dressing " + excerpt(status.garment) + ", step " +
                                     std::to_string(status.step));
    return true;
  };
  std::shared_ptr<const Scene> scene =
      open_scene(std::string(scene_.name), overrides_of(context_.scale, scene_, stretches_[0]),
                 &origin, watch);

  // The new simulator stands at the start of the run.
  simulator_ = make_simulator(context_.build, std::move(scene));
  simulator_->report_energies(false);
  own_ = simulator_->parameters();
  start_hash_ = simulator_->state_hash();
  rows_ = PaperRows();
  recording_ = {};
  recording_.scene = scene_.name;
  recording_.build = build_name(context_.build);
  recording_.overrides = overrides_of(context_.scale, scene_, stretches_[0]);
}

void PaperRun::resume() {
  const std::string name = run_name(scene_, stretches_[0]);
  const Json* saved = context_.store.find(name + "/run", key());
  const std::string path = context_.store.checkpoint_path(name);
  std::error_code error;
  if (!saved || !std::filesystem::exists(path, error)) return;

  // The rows are written before the state, so that there may be more of them than it needs.
  rows_ = PaperRows(saved->at("rows"));
  const Snapshot start = simulator_->snapshot();
  const auto checkpoint = load(path, -1);
  if (!checkpoint) {
    rows_ = PaperRows();
    simulator_->restore(start);
    return;
  }
  recording_ = checkpoint->recording;
  rows_.keep_first(recording_.steps.size());
  context_.progress.plan(-static_cast<double>(rows_.size()) * step_cost());
}

std::optional<Checkpoint> PaperRun::load(const std::string& path, std::int64_t steps) {
  std::error_code error;
  if (path.empty() || !std::filesystem::exists(path, error)) return std::nullopt;
  const auto refuse = [&](const std::string& why) {
    context_.store.note(shown_path(path) + ": " + why + ": the run begins anew");
    return std::nullopt;
  };

  // A state counts when it is whole, of this start, and the one whose hash the run has noted.
  Checkpoint checkpoint;
  try {
    checkpoint = load_checkpoint(path);
  } catch (const InputError& failure) {
    return refuse(failure.what());
  }
  const auto made = static_cast<std::size_t>(checkpoint.steps());
  if (checkpoint.start_hash != start_hash_ || checkpoint.recording.build != recording_.build ||
      (steps >= 0 && checkpoint.steps() != steps) || made > rows_.size() || made == 0 ||
      rows_.json().at("hash").at(made - 1) != hash_text(checkpoint.recording.final_hash))
    return refuse("of another run");

  // The state itself is checked by restoring it.
  try {
    simulator_->restore(checkpoint.state);
  } catch (const std::invalid_argument& failure) {
    return refuse(failure.what());
  }
  if (simulator_->state_hash() != checkpoint.recording.final_hash) return refuse("damaged");
  return checkpoint;
}

void PaperRun::save(const std::string& path) const {
  if (path.empty()) return;
  Checkpoint checkpoint{recording_, start_hash_, simulator_->snapshot()};
  checkpoint.recording.final_hash = simulator_->state_hash();
  save_checkpoint(checkpoint, path);
}

void PaperRun::save_run() {
  const std::string name = run_name(scene_, stretches_[0]);
  context_.store.put(name + "/run", key(), {{"rows", rows_.json()}});
  save(context_.store.checkpoint_path(name));
}

/// A refused step is passed over and counted: the bodies go on.
void PaperRun::step_once() {
  const StepReport report = simulator_->step({});
  if (!report.accepted) simulator_->pass_over();
  StepReport kept = report;
  kept.state_hash = simulator_->state_hash();
  rows_.add(kept);
  recording_.steps.push_back({{}, {}, !report.accepted});
}

void PaperRun::advance_to(long step) {
  simulator_->set_parameters(own_);
  Clock::time_point saved = Clock::now();
  const std::string title = std::string(scene_.title) + ": step ";

  // The state is saved from time to time, and when a signal ends the run.
  try {
    while (static_cast<long>(rows_.size()) < step) {
      step_once();
      context_.progress.advance(
          step_cost(), title + std::to_string(rows_.size()) + " of " + std::to_string(step));
      if (seconds_since(saved) < kSaveInterval) continue;
      save_run();
      saved = Clock::now();
    }
  } catch (const PaperInterrupted&) {
    save_run();
    throw;
  }
}

/// The bandwidth of the memory at this moment [B/s]. Times of tiny scenes mean nothing, so that it
/// is 0 there.
double PaperRun::bandwidth_now() const {
  return context_.scale < kSmallestTimed ? 0 : measure_memory_bandwidth();
}

/// Measures a stretch at whose beginning the run stands, and goes to its end.
void PaperRun::measure_stretch(const Stretch& stretch) {
  const Snapshot start = simulator_->snapshot();
  save_run();
  save(stretch_path(stretch));

  // Our own way is the last one, and the run goes on from its end. Where it was measured before,
  // its steps are made again.
  if (const auto own = measure_modes(stretch, start)) {
    rows_.append(*own);
    for (const Json& refused : own->at("refused"))
      recording_.steps.push_back({{}, {}, refused == 1});
  } else {
    simulator_->restore(start);
    advance_to(stretch.end());
  }
  save_run();
}

/// Measures what is missing. Returns the steps of our own way where it was measured now, which is
/// done last.
std::optional<PaperRun::Json> PaperRun::measure_modes(const Stretch& stretch,
                                                      const Snapshot& start) {
  const double before = bandwidth_now();
  std::optional<Json> own;
  for (const PaperMode& mode : modes_of(scene_, stretch)) {
    const std::string name = measurement_name(scene_, stretch, mode.name);
    if (context_.store.find(name, key())) continue;
    Json result = measure_mode(stretch, mode, start);
    if (mode.name == kOwnMode) own = result["rows"];
    context_.store.put(name, key(), std::move(result));
  }
  context_.store.put(measurement_name(scene_, stretch, kMachine), key(),
                     {{"before", before}, {"after", bandwidth_now()}});
  return own;
}

PaperRun::Json PaperRun::measure_mode(const Stretch& stretch, const PaperMode& mode,
                                      const Snapshot& start) {
  Parameters parameters = own_;
  if (mode.change) mode.change(parameters);
  simulator_->set_parameters(parameters);
  simulator_->restore(start);
  Json result = {{"start_hash", hash_text(simulator_->state_hash())}};
  const std::string what =
      std::string(scene_.title) + " " + stretch_text(stretch) + ", " + mode.name;

  // The steps themselves, while the processor is watched.
  reset_peak_memory();
  PaperRows rows;
  const ProcessorWatch watch;
  for (long step = 0; step < mode.steps; ++step) {
    StepReport report = simulator_->step({});
    if (!report.accepted) {
      simulator_->pass_over();
      report.state_hash = simulator_->state_hash();
    }
    rows.add(report, mode.impacts);
    context_.progress.advance(mode.cost * step_cost(), what + ", step " + std::to_string(step + 1) +
                                                           " of " + std::to_string(mode.steps));
    if (watch.seconds() > kMostSeconds && mode.name != kOwnMode) {
      context_.progress.plan(-mode.cost * step_cost() * static_cast<double>(mode.steps - step - 1));
      break;
    }
  }
  result["seconds"] = watch.seconds();
  result["cores_share"] = watch.own_share(context_.threads);
  result["others_share"] = watch.others_share();

  // Whether anything went through anything.
  result["peak_memory"] = peak_memory_bytes();
  result["penetrations"] = count_penetrations(*simulator_);
  result["rows"] = rows.json();

  // A line for those who watch; it says when others used the machine as well.
  const auto steps = static_cast<double>(rows.size());
  const double others = result["others_share"];
  std::string line = what + ": " + std::to_string(rows.size()) + " steps, " +
                     rounded_text(1e3 * steps / sum_of(rows.json(), "ms_total")) + " steps/s";
  if (others > kMostOthers)
    line += " (others used " + rounded_text(100 * others) + " % of the cores)";
  context_.progress.print(line);
  return result;
}

}  // namespace icloth
