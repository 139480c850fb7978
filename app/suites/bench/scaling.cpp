#include "app/suites/bench/scaling.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "app/common/headless.h"
#include "app/common/interrupt.h"
#include "app/common/machine.h"
#include "app/common/progress.h"
#include "app/suites/bench/scaling_report.h"
#include "app/suites/bench/suite.h"
#include "sim/scene/scene_io.h"

namespace icloth {
namespace {

// The scene is Sphere from the moment at which the ball is about to touch. In the lead-in it pushes
// the three sheets together, and all sizes are measured over the same simulated time.
constexpr const char* kScene = "sphere";
constexpr double kTimeStep = 0.01, kBallAhead = 0.27;  // [s]
constexpr long kLeadIn = 12, kMeasured = 5;

struct Size {
  const char* name;
  double triangles;
};
constexpr Size kSizes[] = {{"10K", 1e4},  {"20K", 2e4},  {"50K", 5e4}, {"100K", 1e5},
                           {"200K", 2e5}, {"500K", 5e5}, {"1M", 1e6}};

/// Work grows a little faster than the mesh.
double work(double triangles) { return std::pow(triangles, 1.1); }

/// One line on the terminal with the time left, by the work that was done so far.
class ScalingProgress {
 public:
  ScalingProgress(double total, bool quiet)
      : total_(total), enabled_(!quiet && isatty(STDERR_FILENO)) {}
  ~ScalingProgress() { clear(); }
  ScalingProgress(const ScalingProgress&) = delete;
  ScalingProgress& operator=(const ScalingProgress&) = delete;

  void advance(double done, const std::string& what) {
    done_ += done;
    if (!enabled_) return;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
    std::fprintf(stderr, "\r\033[Kscaling: %s, %s left", what.c_str(),
                 duration_text(passed.count() * (total_ - done_) / done_).c_str());
    std::fflush(stderr);
    shown_ = true;
  }
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
  }

 private:
  double total_, done_ = 0;
  bool enabled_, shown_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::shared_ptr<const Scene> scaling_scene(double triangles) {
  const std::vector<std::string> overrides = {"triangles=" + format_number(triangles, 9),
                                              "step.time_step=" + format_number(kTimeStep)};
  Scene scene = *load_scene(kScene, overrides);
  for (Keyframe& key : scene.obstacles.front().motion) key.time -= kBallAhead;
  return std::make_shared<const Scene>(std::move(scene));
}

/// The bandwidth of the memory that the build computes in [bytes/s].
double bandwidth(Build build) {
  const ComputeDevice device = compute_device(build);
  return device.name.empty() ? measure_memory_bandwidth() : device.copy_bandwidth;
}

/// Runs one size. Nothing where a signal ends it before the last step.
std::optional<ScalingRow> measure(const Size& size, double triangles, Build build,
                                  const InterruptWatch& interrupts, ScalingProgress& progress) {
  ScalingRow row;
  reset_peak_memory();
  const std::shared_ptr<const Scene> scene = scaling_scene(triangles);
  row.mesh = count_elements(*scene);
  row.thickness = scene->parameters.proximity.thickness;
  const std::unique_ptr<Simulator> simulator = make_simulator(build, scene);
  simulator->report_energies(false);

  // The lead-in brings arrays to their size and the sheets into contact.
  for (long step = 0; step < kLeadIn + kMeasured; ++step) {
    const StepReport report = simulator->step({});
    if (!report.accepted) ++row.refused;
    if (step >= kLeadIn) row.steps.add(report);
    progress.advance(work(triangles), std::string(size.name) + ", step " +
                                          std::to_string(step + 1) + " of " +
                                          std::to_string(kLeadIn + kMeasured));
    if (interrupts.noted()) return {};
  }
  row.peak_memory = peak_memory_bytes();
  row.bandwidth = bandwidth(build);
  row.penetrations = count_penetrations(*simulator);
  return row;
}

std::vector<Size> chosen_sizes(const BenchOptions& options) {
  std::vector<Size> sizes;
  for (const Size& size : kSizes)
    if (chosen(options, size.name)) sizes.push_back(size);
  if (sizes.empty()) throw no_such_case(options);
  return sizes;
}

}  // namespace

int run_scaling(const BenchOptions& options) {
  const std::vector<Size> sizes = chosen_sizes(options);
  const Build build = only_build(options);
  Report report = begin_report(options, build);

  // The time left follows from the work of all sizes.
  double total = 0;
  for (const Size& size : sizes)
    total += static_cast<double>(kLeadIn + kMeasured) * work(size.triangles * options.scale);
  ScalingProgress progress(total, options.quiet);
  InterruptWatch interrupts;

  std::vector<ScalingRow> rows;
  bool clean = true;
  for (const Size& size : sizes) {
    const std::optional<ScalingRow> row =
        measure(size, size.triangles * options.scale, build, interrupts, progress);
    if (!row) break;
    progress.clear();
    rows.push_back(*row);
    clean = clean && row->refused == 0 && row->penetrations == 0;
    std::printf("%s: %.0f triangles, %.4g ms a step, %.0f MB\n", size.name, row->mesh.cloth_faces,
                row->steps.median("ms_total"), row->peak_memory / 1e6);
    std::fflush(stdout);
  }
  progress.clear();

  // A signal leaves a report of the sizes that were finished.
  report_scaling(rows, report);
  const char* const signal = interrupts.noted();
  if (signal) {
    report.text("Ended by " + std::string(signal) + " after " + std::to_string(rows.size()) +
                " of " + std::to_string(sizes.size()) + " sizes.");
    std::fprintf(stderr, "icloth: ended by %s after %zu of %zu sizes; the report has these\n",
                 signal, rows.size(), sizes.size());
  }
  finish_report(options, report);
  return clean && !signal ? 0 : 1;
}

}  // namespace icloth
