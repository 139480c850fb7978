#include "app/suites/bench/paper_sphere.h"

#include <algorithm>
#include <cmath>

#include "app/suites/bench/frames.h"
#include "app/suites/bench/paper_modes.h"
#include "app/suites/bench/zone_trial.h"

namespace icloth {
namespace {

// The scene is the paper's Sphere in a smaller version. Without repulsion all contact is left to
// impacts: thousands a step while the ball pushes into the sheets, like the paper's tangled frames.
const std::string kScene = "sphere";
constexpr int kTriangles = 10000, kRounds = 30, kManyRounds = 200;
constexpr long kFirst = 40, kLast = 120, kEvery = 8;

std::string count(double value) { return format_number(value, 9); }

const char* on_off(bool on) { return on ? "on" : "off"; }

/// The overrides of a run; `tangled`: without repulsion.
std::vector<std::string> overrides(double scale, bool tangled) {
  const long triangles = std::lround(std::clamp(kTriangles * scale, 1000.0, double(kTriangles)));
  std::vector<std::string> list = {"triangles=" + std::to_string(triangles), "step.time_step=0.01"};
  if (tangled) list.emplace_back("proximity.enabled=off");
  return list;
}

/// Impacts that were left after the last round, before vertices were put back to their start.
double impacts_left(const StepReport& step) {
  return step.impacts_in_rounds.empty() ? 0 : static_cast<double>(step.impacts_in_rounds.back());
}

/// Fig. 13: counts the impacts that are left without repulsion, without impact zones, and with
/// both.
bool compare_responses(const SphereSetup& setup, Section& section) {
  section.heading = "What repulsion and impact zones do (Fig. 13)";
  section.texts.emplace_back(
      "From the same states one step is taken in four ways. The paper's three cases on its "
      "version of this scene: 1065, 62 and 0 impacts.");

  // The states come from a run in which everything is on.
  Frames frames(setup.build, kScene, overrides(setup.scale, false), kFirst, kLast, kEvery,
                setup.watch);
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
          single_attempt(p, kRounds);
          p.proximity.enabled = proximity;
          p.impact_zones.enabled = zones;
        });
        first += static_cast<double>(step.impacts_first);
        left += impacts_left(step);
        if (step.accepted) penetrations += frames.penetrations();
      }
      clean = clean && penetrations == 0;

      // A state with penetrations must not pass as a solution.
      table.add({on_off(proximity), on_off(zones), count(first), count(left),
                 std::to_string(penetrations)});
    }
  }
  section.tables.push_back(table);
  return clean;
}

/// Fig. 9: counts the box tests and elementary tests of a full and of an incremental detection.
void compare_incremental(Frames& frames, Section& section) {
  section.heading = "Incremental collision detection on the simplified Sphere";
  section.texts.emplace_back(
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
  section.tables.push_back(table);
}

constexpr std::pair<ZoneSolver, const char*> kSolvers[] = {
    {ZoneSolver::augmented_lagrangian, "augmented_lagrangian"},
    {ZoneSolver::dual, "dual"},
    {ZoneSolver::linear, "linear"}};

/// Fig. 10: compares the solvers of impact zones on frames that tangle.
void compare_zone_solvers(Frames& frames, Section& section) {
  section.heading = "Solvers of impact zones on the simplified Sphere";
  section.texts.emplace_back(
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
        single_attempt(p, kManyRounds);
        p.impact_zones.solver = chosen;
        delta = p.impact_zones.offset;
      });

      // Collision handling is the broad phase, CCD and the zones.
      const double mine = step.ms_broad_phase + step.ms_ccd + step.ms_impact_zones;
      rounds += static_cast<double>(step.rounds);
      iterations += static_cast<double>(step.zone_iterations);
      ms += mine;
      left += impacts_left(step);
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
  section.tables.push_back(table);
  section.plots.push_back(plot);
}

/// Compares the solvers on made-up zones with the optimum.
void compare_with_optimum(Section& section) {
  section.heading = "Distance to the optimum of Eq. 1";
  section.texts.emplace_back(
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
  section.tables.push_back(table);
}

/// Fig. 7 and 11: compares larger time steps.
bool compare_time_steps(const SphereSetup& setup, Section& section) {
  section.heading = "Larger time steps on the simplified Sphere";
  section.texts.emplace_back(
      "One simulated second with each time step. The paper leaves 1002 impacts at 1/20 s on "
      "its Dress scene; here what a step cannot resolve is cut into substeps.");
  Table table("time_steps", "Simplified Sphere, without repulsion",
              {"time step [s]", "steps", "substeps", "retries", "mean rounds", "most impacts",
               "refused steps", "penetrations", "seconds a simulated second"});

  // Each time step simulates the same second.
  bool clean = true;
  for (const int rate : {200, 100, 50, 20}) {
    std::vector<std::string> changed = overrides(setup.scale, true);
    changed[1] = "step.time_step=" + format_number(1.0 / rate, 6);
    Frames frames(setup.build, kScene, changed, rate, rate, 1, setup.watch);

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
  section.tables.push_back(table);
  return clean;
}

/// Compares the two broad phases on the same states.
void compare_broad_phases(Frames& frames, Section& section) {
  section.heading = "Broad phases: trees and spatial hashing";
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
  section.tables.push_back(table);
}

}  // namespace

SphereSections measure_responses(const SphereSetup& setup) {
  SphereSections result{std::vector<Section>(1)};
  result.clean = compare_responses(setup, result.sections[0]);
  return result;
}

SphereSections measure_tangles(const SphereSetup& setup) {
  // One run gives the tangled states for all three.
  Frames frames(setup.build, kScene, overrides(setup.scale, true), kFirst, kLast, kEvery,
                setup.watch);
  SphereSections result{std::vector<Section>(3)};
  compare_incremental(frames, result.sections[0]);
  setup.watch();
  compare_zone_solvers(frames, result.sections[1]);
  setup.watch();
  compare_broad_phases(frames, result.sections[2]);
  return result;
}

SphereSections measure_optimum(const SphereSetup&) {
  SphereSections result{std::vector<Section>(1)};
  compare_with_optimum(result.sections[0]);
  return result;
}

SphereSections measure_time_steps(const SphereSetup& setup) {
  SphereSections result{std::vector<Section>(1)};
  result.clean = compare_time_steps(setup, result.sections[0]);
  return result;
}

}  // namespace icloth
