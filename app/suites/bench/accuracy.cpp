#include "app/suites/bench/accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/common/progress.h"
#include "app/suites/bench/parts.h"
#include "app/suites/bench/suite.h"
#include "app/suites/bench/trial.h"
#include "app/suites/report/report.h"
#include "sim/scene/presets.h"

namespace icloth {
namespace {

// The scenes are damped a little. Without any damping, waves as short as an edge ring for ever,
// each step length makes other ones, and no two runs come together.
const std::string kDamping = "material.damping=0.002", kStep = "step.time_step=0.01";

const TrialScene kScenes[] = {
    {"flag", 2500, {kStep, kDamping}, 0.1, 4, 4},
    {"scarf", 2500, {kStep, kDamping}, 0.1, 5, 2},
    {"sphere", 3000, {kStep, kDamping}, 0.2, 3, 3},
    {"drape", 3000, {kStep, kDamping}, 0.1, 5, 2},
};

/// One point of the curves: a setting that differs from the scene's own in one thing.
struct Setting {
  const char* knob;
  std::string value;
  std::vector<std::string> overrides;
  bool precise = false;  ///< in double precision
};

/// The settings of the sweep, one knob after the other.
std::vector<Setting> settings(const TrialScene& scene) {
  // The scene's own setting comes first, since the others are measured against it.
  std::vector<Setting> list{{"as in the scene", "1/100 s", {}}};
  for (const Preset& preset : presets())
    list.push_back({"preset", std::string(preset.name), {"preset=" + std::string(preset.name)}});

  const auto add = [&](const char* knob, const char* parameter,
                       std::initializer_list<const char*> values) {
    for (const char* value : values)
      list.push_back({knob, value, {std::string(parameter) + "=" + value}});
  };

  // The time step and the integrator decide how the motion is resolved in time.
  add("time step", "step.time_step", {"0.02", "0.005", "0.0025"});
  for (const char* dt : {"0.02", "0.01", "0.005", "0.0025"})
    list.push_back(
        {"BDF2, time step", dt, {std::string("step.time_step=") + dt, "implicit.integrator=bdf2"}});

  // These settings decide how exactly the implicit step is solved.
  add("Newton iterations", "implicit.newton_iterations", {"1", "2", "3"});
  list.push_back({"Newton iterations",
                  "20, to 0.1 N/m",
                  {"implicit.newton_iterations=20", "implicit.newton_tolerance=0.1"}});
  add("Newton tolerance", "implicit.newton_tolerance", {"0.5", "50"});
  add("CG tolerance", "implicit.cg_tolerance", {"0.1", "0.03", "0.01", "0.001", "0.0001"});
  add("preconditioner", "implicit.preconditioner", {"block_jacobi", "multilevel"});

  // These settings belong to the handling of contacts.
  add("contact passes", "implicit.contact_passes", {"3", "6", "12"});
  add("contact tolerance", "implicit.contact_tolerance", {"0.1", "0.01", "0.001"});
  add("zone solver", "impact_zones.solver", {"augmented_lagrangian", "linear"});
  add("zone iterations", "impact_zones.iterations", {"10", "30", "1000"});

  // Precision, thickness and mesh belong to the scene rather than to the solver.
  list.push_back({"precision", "f64", {}, true});
  const double thickness = trial_scene(scene, {})->parameters.proximity.thickness;
  for (const double factor : {0.5, 2.0})
    list.push_back({"thickness",
                    format_number(1e3 * factor * thickness) + " mm",
                    {"proximity.thickness=" + format_number(factor * thickness)}});
  for (const int triangles : {scene.triangles / 2, 2 * scene.triangles, 4 * scene.triangles})
    list.push_back({"mesh",
                    std::to_string(triangles) + " triangles",
                    {"triangles=" + std::to_string(triangles)}});
  return list;
}

/// Combinations of the settings that matter most, from which the presets are picked.
std::vector<Setting> combinations() {
  // All combinations are run, since one setting's error can hide what another one gains.
  std::vector<Setting> list;
  for (const char* integrator : {"backward_euler", "bdf2"})
    for (const char* dt : {"0.02", "0.01", "0.005"})
      for (const char* tolerance : {"0.05", "0.02", "0.01", "0.001"})
        for (const char* newton : {"1", "3"})
          list.push_back(
              {"combination",
               std::string(integrator) + ", " + dt + " s, CG " + tolerance + ", Newton " + newton,
               {std::string("implicit.integrator=") + integrator,
                std::string("step.time_step=") + dt,
                std::string("implicit.cg_tolerance=") + tolerance,
                std::string("implicit.newton_iterations=") + newton}});
  return list;
}

/// The settings of a reference: the second-order integrator, solved to many digits.
std::vector<std::string> reference_settings(const char* time_step) {
  return {std::string("step.time_step=") + time_step,
          "implicit.integrator=bdf2",
          "implicit.cg_tolerance=1e-7",
          "implicit.cg_max_iterations=5000",
          "implicit.newton_iterations=20",
          "implicit.newton_tolerance=1e-3",
          "implicit.contact_passes=100",
          "implicit.contact_tolerance=1e-4"};
}

/// A setting, the run with it, and its distance from the reference.
struct Point {
  Setting setting;
  Trial trial;
  Errors errors;
  bool front = false;
};

std::string percent(double share, int digits = 3) {
  return share < 0 ? "" : format_number(100 * share, digits);
}

/// The table of all points of a scene. `usual` is the time of the scene's own setting.
Table table_of(const std::string& scene, const std::vector<Point>& points, double usual) {
  Table table("accuracy_" + scene, "Speed against error: " + scene,
              {"setting", "value", "s a simulated second", "times faster", "CG iterations a step",
               "position [mm]", "energy [%]", "momentum [%]", "covered area [%]", "pressed in [%]",
               "largest strain [%]", "violation [δ]", "penetrations", "front"});

  // A scene need not have every error, and a refused run has no final state to check.
  for (const Point& p : points)
    table.add({p.setting.knob, p.setting.value, format_number(p.trial.seconds, 3),
               format_number(usual / p.trial.seconds, 3), format_number(p.trial.cg_iterations, 3),
               p.errors.position < 0 ? "" : format_number(1e3 * p.errors.position, 3),
               percent(p.errors.energy), percent(p.errors.momentum), percent(p.errors.shadow),
               percent(p.trial.pressed, 2), percent(p.trial.strain, 2),
               format_number(p.trial.violation, 2),
               p.trial.finished ? std::to_string(p.trial.penetrations) : "refused",
               p.front ? "*" : ""});
  return table;
}

/// Plots time against error, with one series a knob and the front as a line of its own.
Plot plot_of(const std::string& scene, const std::vector<Point>& points, const char* what,
             double Errors::*error) {
  Plot plot{.title = std::string(what) + ": " + scene,
            .x_label = "seconds a simulated second",
            .y_label = what,
            .log_x = true,
            .log_y = true,
            .markers = true,
            .series = {}};
  Series front{"front", {}};

  // Only the knobs that trade time for error are drawn.
  constexpr std::string_view kDrawn[] = {"time step", "BDF2, time step", "CG tolerance",
                                         "combination", "preset"};
  for (const Point& p : points) {
    const std::pair point(p.trial.seconds, p.errors.*error);
    if (p.front) front.points.push_back(point);
    if (std::ranges::find(kDrawn, p.setting.knob) == std::end(kDrawn)) continue;
    if (plot.series.empty() || plot.series.back().name != p.setting.knob)
      plot.series.push_back({p.setting.knob, {}, p.setting.knob != std::string("combination")});
    plot.series.back().points.push_back(point);
  }

  std::ranges::sort(front.points);
  plot.series.push_back(std::move(front));
  return plot;
}

/// Measures scene after scene and adds them to the report.
class AccuracySuite {
 public:
  AccuracySuite(Build build, bool quiet, Report& report)
      : build_(build), quiet_(quiet), report_(report) {}

  void run(const TrialScene& scene) {
    // The reference is compared with a coarser one, which tells what it can resolve.
    report_.heading(scene.name);
    const Trial reference = run_trial(scene, reference_settings("0.000625"), Build::cpu64);
    const Trial coarser = run_trial(scene, reference_settings("0.00125"), Build::cpu64);
    const Errors own = compare(coarser, reference, scene.samples_alike);
    report_.text("The reference took " + format_number(reference.seconds, 3) +
                 " s a simulated second. With twice its step it is " +
                 format_number(1e3 * own.position, 3) + " mm, " + percent(own.energy) +
                 " % of the energy and " + percent(own.shadow) +
                 " % of the area away: errors below that are not resolved.");

    // Every setting is measured against it, one by one and in the combinations.
    std::vector<Setting> list = settings(scene);
    for (Setting& s : combinations()) list.push_back(std::move(s));
    const std::vector<Point> points = measure(scene, list, reference);

    report_.add(table_of(scene.name, points, points[0].trial.seconds));
    report_.add(plot_of(scene.name, points, "position error [m]", &Errors::position));
    report_.add(plot_of(scene.name, points, "energy error", &Errors::energy));
  }

  bool clean() const { return clean_; }

 private:
  std::vector<Point> measure(const TrialScene& scene, const std::vector<Setting>& list,
                             const Trial& reference) {
    constexpr std::size_t kRounds = 4;
    std::vector<Point> points;
    Progress progress(scene.name, static_cast<long>(kRounds * list.size()), quiet_);
    const auto run = [&](const Setting& setting) {
      const Build build = setting.precise ? Build::cpu64 : build_;
      return run_trial(scene, setting.overrides, build);
    };

    // The first run of each setting gives its errors as well as a time.
    for (const Setting& setting : list) {
      Point point{setting, run(setting), {}};
      point.errors = compare(point.trial, reference, scene.samples_alike);
      clean_ = clean_ && point.trial.finished && point.trial.penetrations == 0;
      points.push_back(std::move(point));
      progress.update(static_cast<long>(points.size()));
    }

    // Further rounds take the settings in turns, so that a slow hour of the machine slows all of
    // them or none. Settings that lead to the same run share one time: the fastest of more attempts
    // would be faster by chance.
    std::vector<std::size_t> first(points.size());
    for (std::size_t k = 0; k < points.size(); ++k)
      while (first[k] < k && !same_run(points[first[k]].trial, points[k].trial)) ++first[k];

    for (std::size_t round = 1; round < kRounds; ++round) {
      for (std::size_t k = 0; k < points.size(); ++k) {
        double& seconds = points[k].trial.seconds;
        if (first[k] == k) seconds = std::min(seconds, run(points[k].setting).seconds);
        progress.update(static_cast<long>(round * list.size() + k + 1));
      }
    }
    for (std::size_t k = 0; k < points.size(); ++k)
      points[k].trial.seconds = points[first[k]].trial.seconds;

    // The front holds the settings that no other beats in both time and error.
    std::vector<std::pair<double, double>> places;
    for (const Point& p : points)
      places.emplace_back(p.trial.seconds, p.errors.position < 0 ? HUGE_VAL : p.errors.position);
    const std::vector<bool> front = pareto_front(places);
    for (std::size_t k = 0; k < points.size(); ++k)
      points[k].front = front[k] && points[k].errors.position >= 0;
    return points;
  }

  Build build_;
  bool quiet_;
  Report& report_;
  bool clean_ = true;
};

}  // namespace

int run_accuracy(const BenchOptions& options) {
  const Build build = only_build(options);
  Report report = begin_report(options, build);
  AccuracySuite suite(build, options.quiet, report);

  // --case may name one scene, or the parts of a scene.
  bool any = false;
  for (const TrialScene& scene : kScenes) {
    if (!chosen(options, scene.name)) continue;
    suite.run(scene);
    any = true;
  }
  if (chosen(options, "parts")) show_parts(build, report), any = true;

  if (!any) throw no_such_case(options);
  finish_report(options, report);
  return suite.clean() ? 0 : 1;
}

}  // namespace icloth
