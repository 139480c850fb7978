#include "app/suites/bench/paper.h"

#include <cstdio>

#include "app/suites/bench/frames.h"
#include "app/suites/bench/suite.h"
#include "app/suites/bench/zone_trial.h"
#include "app/suites/report/report.h"

namespace icloth {
namespace {

// The scene is the paper's Sphere in a smaller version. Without repulsion all contact is left to
// impacts: thousands a step while the ball pushes into the sheets, like the paper's tangled frames.
const std::string kScene = "sphere";
const std::vector<std::string> kSimple = {"triangles=10000", "step.time_step=0.01"};
const std::vector<std::string> kTangled = {"triangles=10000", "step.time_step=0.01",
                                           "proximity.enabled=off"};
constexpr long kFirst = 40, kLast = 120, kEvery = 8;

std::string count(double value) { return format_number(value, 9); }

const char* on_off(bool on) { return on ? "on" : "off"; }

/// Leaves one attempt at the whole step, and nothing to fall back on.
void single_attempt(Parameters& p) {
  p.step.max_substep_levels = 0;
  p.step.max_travel = 100;
  p.impact_zones.max_correction = 100;
}

/// Fig. 13: counts the impacts that are left without repulsion, without impact zones, and with
/// both.
bool compare_responses(Build build, Report& report) {
  report.heading("What repulsion and impact zones do (Fig. 13)");
  report.text(
      "From the same states one step is taken in four ways. The paper's three cases on its "
      "version of this scene: 1065, 62 and 0 impacts.");

  // The states come from a run in which everything is on.
  Frames frames(build, kScene, kSimple, kFirst, kLast, kEvery);
  Table table("response", "Sum over " + std::to_string(frames.states().size()) + " states",
              {"proximity", "impact zones", "impacts after integration", "impacts left",
               "penetrations accepted"});

  // Each of the four combinations takes one step from every state.
  bool clean = true;
  for (const bool proximity : {false, true}) {
    for (const bool zones : {false, true}) {
      double first = 0, left = 0;
      std::size_t penetrations = 0;
      for (const Snapshot& state : frames.states()) {
        const StepReport step = frames.step(state, [&](Parameters& p) {
          single_attempt(p);
          p.proximity.enabled = proximity;
          p.impact_zones.enabled = zones;
        });
        first += static_cast<double>(step.impacts_first);
        left += static_cast<double>(step.impacts_left);
        if (step.accepted) penetrations += frames.penetrations();
      }
      clean = clean && penetrations == 0;

      // A state with penetrations must not pass as a solution.
      table.add({on_off(proximity), on_off(zones), count(first), count(left),
                 std::to_string(penetrations)});
    }
  }
  report.add(table);
  return clean;
}

/// Fig. 9: counts the box tests and elementary tests of a full and of an incremental detection.
void compare_incremental(Frames& frames, Report& report) {
  report.heading("Incremental collision detection (Fig. 9)");
  report.text(
      "Steps from tangled states. Both versions find the same impacts in every round. The "
      "paper counts 3.68 times fewer box tests on a frame of four rounds.");

  Table table("incremental", "Tests in all rounds of a step",
              {"step", "rounds", "box tests full", "incremental", "ratio", "elementary tests full",
               "incremental (elementary)", "ratio (elementary)", "same state"});

  // Each state takes the same step twice, and must end in the same bits.
  for (const Snapshot& state : frames.states()) {
    StepReport step[2];
    for (const bool incremental : {false, true})
      step[incremental ? 1 : 0] = frames.step(state, [&](Parameters& p) {
        p.ccd.incremental = incremental;
        p.broad_phase.count_tests = true;
      });

    // The ratios tell how many tests the incremental detection saves.
    const auto number = [](std::int64_t value) { return static_cast<double>(value); };
    table.add(
        {std::to_string(state.step + 1), std::to_string(step[0].rounds),
         count(number(step[0].box_tests)), count(number(step[1].box_tests)),
         format_number(number(step[0].box_tests) / number(step[1].box_tests), 3),
         count(number(step[0].elementary_tests)), count(number(step[1].elementary_tests)),
         format_number(number(step[0].elementary_tests) / number(step[1].elementary_tests), 3),
         step[0].state_hash == step[1].state_hash ? "yes" : "no"});
  }
  report.add(table);
}

constexpr std::pair<ZoneSolver, const char*> kSolvers[] = {
    {ZoneSolver::augmented_lagrangian, "augmented_lagrangian"},
    {ZoneSolver::dual, "dual"},
    {ZoneSolver::linear, "linear"}};

/// Fig. 10: compares the solvers of impact zones on frames that tangle.
void compare_zone_solvers(Frames& frames, Report& report) {
  report.heading("Solvers of impact zones (Fig. 10)");
  report.text(
      "Steps from the same tangled states, one attempt of at most 200 rounds each. The "
      "linear solver is the inelastic projection of Harmon et al. 2008, which the paper "
      "compares with: 174 against 34 iterations and 12.82 ms against 2.86 ms on one frame.");

  // The table has means over the states, the plot has the time of every step.
  Table table("zone_solvers", "Mean of a step",
              {"solver", "rounds", "iterations", "ms collisions", "impacts left", "max strain",
               "violation / δ", "momentum error"});
  Plot plot{.title = "Collision handling of single steps",
            .x_label = "step",
            .y_label = "ms",
            .log_y = true,
            .markers = true,
            .series = {}};

  for (const auto& [solver, name] : kSolvers) {
    double rounds = 0, iterations = 0, ms = 0, left = 0, strain = 0, violation = 0, momentum = 0;
    Series series{name, {}};

    // Every solver takes one step from the same states, in one attempt.
    for (const Snapshot& state : frames.states()) {
      double delta = 1;
      const StepReport step = frames.step(state, [&, chosen = solver](Parameters& p) {
        single_attempt(p);
        p.impact_zones.solver = chosen;
        p.impact_zones.max_rounds = 200;
        delta = p.impact_zones.offset;
      });

      // Collision handling is the broad phase, CCD and the zones.
      const double mine = step.ms_broad_phase + step.ms_ccd + step.ms_impact_zones;
      rounds += static_cast<double>(step.rounds);
      iterations += static_cast<double>(step.zone_iterations);
      ms += mine;
      left += static_cast<double>(step.impacts_left);
      strain = std::max(strain, step.max_strain);

      // The worst state counts for strain and residuals.
      violation = std::max(violation, step.zone_violation / delta);
      momentum = std::max(momentum, step.zone_momentum_residual);
      series.points.emplace_back(static_cast<double>(state.step + 1), mine);
    }

    const auto n = static_cast<double>(frames.states().size());
    table.add({name, format_number(rounds / n), format_number(iterations / n),
               format_number(ms / n), count(left), format_number(strain, 3),
               format_number(violation, 3), format_number(momentum, 2)});
    plot.series.push_back(std::move(series));
  }
  report.add(table);
  report.add(plot);
}

/// Compares the solvers on made-up zones with the optimum.
void compare_with_optimum(Report& report) {
  report.heading("Distance to the optimum of Eq. 1");
  report.text(
      "Two sheets that have gone 2 mm through each other; at most 100 iterations. The "
      "objective is divided by that of the optimum (dual solver in double precision).");

  Table table("optimum", "One zone",
              {"vertices", "constraints", "solver", "iterations", "objective / optimum",
               "violation [m]", "complementarity [m]", "momentum error", "ms"});

  // The sizes go from a handful of vertices to a zone that needs the whole device.
  for (const Index side : {5, 15, 50, 150}) {
    const double optimum = cpu64::solve_zone_trial(side, ZoneSolver::dual, 10000).objective;
    for (const auto& [solver, name] : kSolvers) {
      const ZoneTrial trial = cpu32::solve_zone_trial(side, solver, 100);
      table.add({std::to_string(trial.vertices), std::to_string(trial.constraints), name,
                 std::to_string(trial.iterations), format_number(trial.objective / optimum, 6),
                 format_number(trial.violation, 3), format_number(trial.complementarity, 3),
                 format_number(trial.momentum_residual, 2), format_number(trial.milliseconds, 3)});
    }
  }
  report.add(table);
}

/// Fig. 5 and 6: shows rounds and iterations of every step.
void show_iterations(const Frames& frames, Report& report) {
  report.heading("Iterations of every step (Fig. 5 and 6)");
  Plot iterations{
      .title = "Rounds and iterations of the zone solver",
      .x_label = "step",
      .y_label = "count",
      .log_y = true,
      .series = {{"rounds", {}}, {"iterations, all rounds", {}}, {"impacts before", {}}}};
  Plot time{.title = "Time of the impact zones",
            .x_label = "step",
            .y_label = "ms",
            .series = {{"impact_zones", {}}}};

  // The plots go over the steps, and the table needs the extremes.
  double rounds = 0, most_rounds = 0, most_iterations = 0;
  for (const StepReport& step : frames.reports()) {
    const auto x = static_cast<double>(step.step);
    const auto r = static_cast<double>(step.rounds), i = static_cast<double>(step.zone_iterations);
    iterations.series[0].points.emplace_back(x, r);
    iterations.series[1].points.emplace_back(x, i);
    iterations.series[2].points.emplace_back(x, static_cast<double>(step.impacts_first));
    time.series[0].points.emplace_back(x, step.ms_impact_zones);
    rounds += r;
    most_rounds = std::max(most_rounds, r);
    most_iterations = std::max(most_iterations, i);
  }

  // The table holds the mean and the extremes.
  Table table("iterations", "Over " + std::to_string(frames.reports().size()) + " steps",
              {"mean rounds", "most rounds", "most iterations"});
  table.add({format_number(rounds / static_cast<double>(frames.reports().size()), 3),
             count(most_rounds), count(most_iterations)});
  report.add(table);
  report.add(iterations);
  report.add(time);
}

/// Fig. 7 and 11: compares larger time steps.
bool compare_time_steps(Build build, Report& report) {
  report.heading("Larger time steps (Fig. 7 and 11)");
  report.text(
      "One simulated second with each time step. The paper leaves 1002 impacts at 1/20 s on "
      "its Dress scene; here what a step cannot resolve is cut into substeps.");
  Table table("time_steps", "Sphere, 10K triangles, without repulsion",
              {"time step [s]", "steps", "substeps", "retries", "mean rounds", "most impacts",
               "refused steps", "penetrations", "seconds a simulated second"});

  // Each time step simulates the same second.
  bool clean = true;
  for (const int rate : {200, 100, 50, 20}) {
    std::vector<std::string> overrides = kTangled;
    overrides[1] = "step.time_step=" + format_number(1.0 / rate, 6);
    Frames frames(build, kScene, overrides, rate, rate, 1);

    double substeps = 0, retries = 0, rounds = 0, impacts = 0, ms = 0;
    int refused = 0;
    for (const StepReport& step : frames.reports()) {
      substeps += static_cast<double>(step.substeps);
      retries += static_cast<double>(step.retries);
      rounds += static_cast<double>(step.rounds);
      impacts = std::max(impacts, static_cast<double>(step.impacts_first));
      ms += step.ms_total;
      refused += step.accepted ? 0 : 1;
    }

    // The final state is checked exactly, however the steps went.
    const std::size_t penetrations = frames.penetrations();
    clean = clean && penetrations == 0;
    table.add({"1/" + std::to_string(rate), std::to_string(rate), count(substeps), count(retries),
               format_number(rounds / rate, 3), count(impacts), std::to_string(refused),
               std::to_string(penetrations), format_number(ms / 1000, 3)});
  }
  report.add(table);
  return clean;
}

/// Compares the two broad phases on the same states.
void compare_broad_phases(Frames& frames, Report& report) {
  report.heading("Broad phases: trees and spatial hashing");
  Table table("broad_phase", "Mean of a step",
              {"method", "ms broad_phase", "box tests", "candidate pairs", "same state"});
  std::vector<std::uint64_t> expected;
  constexpr std::pair<BroadPhaseMethod, const char*> kMethods[] = {
      {BroadPhaseMethod::tree, "tree"}, {BroadPhaseMethod::hash, "hash"}};

  // Both must find the same pairs, and so lead to the same states.
  for (const auto& [method, name] : kMethods) {
    double ms = 0, tests = 0, pairs = 0;
    std::vector<std::uint64_t> hashes;
    for (const Snapshot& state : frames.states()) {
      // Counting boxes takes time, so the counts come from a step of their own.
      const auto with = [chosen = method](bool count_tests) {
        return [chosen, count_tests](Parameters& p) {
          p.broad_phase.method = chosen;
          p.broad_phase.count_tests = count_tests;
        };
      };
      tests += static_cast<double>(frames.step(state, with(true)).box_tests);
      const StepReport step = frames.step(state, with(false));
      ms += step.ms_broad_phase;
      pairs += static_cast<double>(step.candidate_pairs);
      hashes.push_back(step.state_hash);
    }

    if (expected.empty()) expected = hashes;
    const auto n = static_cast<double>(frames.states().size());
    table.add({name, format_number(ms / n), format_number(tests / n), format_number(pairs / n),
               hashes == expected ? "yes" : "no"});
  }
  report.add(table);
}

}  // namespace

int run_paper(const BenchOptions& options) {
  const Build build = only_build(options);
  Report report = begin_report(options, build);

  // Contact responses first, then what impact zones and detection do to tangled states.
  bool clean = compare_responses(build, report);

  // The tangled states serve all comparisons of collision handling.
  {
    Frames frames(build, kScene, kTangled, kFirst, kLast, kEvery);
    compare_incremental(frames, report);
    compare_zone_solvers(frames, report);
    compare_broad_phases(frames, report);
    show_iterations(frames, report);
  }

  compare_with_optimum(report);
  clean = compare_time_steps(build, report) && clean;
  finish_report(options, report);
  return clean ? 0 : 1;
}

}  // namespace icloth
