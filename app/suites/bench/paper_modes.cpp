#include "app/suites/bench/paper_modes.h"

#include "sim/scene/presets.h"

namespace icloth {
namespace {

constexpr long kBaselineSteps = 5;
constexpr int kManyRounds = 200;    // as in the paper's Fig. 7
constexpr int kAttemptRounds = 50;  // where it is enough to see whether a solver gets ahead

/// Adds single attempts with the solver of the paper, ours and the linear one.
void add_single_attempts(std::vector<PaperMode>& modes) {
  constexpr std::pair<ZoneSolver, const char*> kSolvers[] = {
      {ZoneSolver::augmented_lagrangian, "single gradient"},
      {ZoneSolver::dual, "single dual"},
      {ZoneSolver::linear, "single linear"}};
  for (const auto& [solver, name] : kSolvers)
    modes.push_back({name, 1,
                     [chosen = solver](Parameters& p) {
                       single_attempt(p, kAttemptRounds);
                       p.impact_zones.solver = chosen;
                     },
                     4, true});
}

/// Fig. 7: a step of 1/20 s and one of 1/50 s, in one attempt with the paper's solver and with
/// ours, and as our program makes them.
void add_large_steps(std::vector<PaperMode>& modes) {
  for (const int rate : {20, 50}) {
    const std::string name = " 1/" + std::to_string(rate);

    // A single attempt is what the paper's figure shows.
    const auto add = [&](const std::string& kind, bool single, ZoneSolver solver) {
      modes.push_back({kind + name, 1,
                       [=](Parameters& p) {
                         p.step.time_step = 1.0 / rate;
                         if (single) single_attempt(p, kManyRounds);
                         p.impact_zones.solver = solver;
                       },
                       8, true});
    };
    add("gradient", true, ZoneSolver::augmented_lagrangian);
    add("dual", true, ZoneSolver::dual);
    add("whole", false, ZoneSolver::dual);
  }
}

/// Fig. 11: the time of the stretch with other time steps.
void add_time_steps(std::vector<PaperMode>& modes, const PaperScene& scene,
                    const Stretch& stretch) {
  for (const int rate : {200, 50})
    modes.push_back({"1/" + std::to_string(rate), stretch.steps * rate / scene.rate,
                     [rate](Parameters& p) { p.step.time_step = 1.0 / rate; },
                     rate < scene.rate ? 1.5 : 0.8});
}

/// Fig. 9: the same steps with counted tests, all pairs in every round and those of dirty vertices.
void add_counts(std::vector<PaperMode>& modes) {
  for (const bool incremental : {false, true})
    modes.push_back({incremental ? "counted incremental" : "counted full", kBaselineSteps,
                     [incremental](Parameters& p) {
                       p.ccd.incremental = incremental;
                       p.broad_phase.count_tests = true;
                     },
                     2});
}

}  // namespace

void single_attempt(Parameters& p, int rounds) {
  p.step.max_substep_levels = 0;
  p.step.max_travel = 100;
  p.proximity.late_rounds = 0;
  p.impact_zones.max_correction = 100;
  p.impact_zones.max_rounds = rounds;
}

std::vector<PaperMode> modes_of(const PaperScene& scene, const Stretch& stretch) {
  // The two baselines are the same for all scenes.
  std::vector<PaperMode> modes;
  for (const Preset& mode : collision_modes())
    if (mode.name != kOwnMode)
      modes.push_back({std::string(mode.name), kBaselineSteps,
                       [&mode](Parameters& p) { apply_preset(p, mode); }, 6});
  add_single_attempts(modes);

  // Some figures of the paper are of one scene.
  if (scene.name == "andy" || scene.name == "funnel")
    modes.push_back(
        {"gradient", scene.name == "andy" ? stretch.steps : kBaselineSteps,
         [](Parameters& p) { p.impact_zones.solver = ZoneSolver::augmented_lagrangian; }, 2});
  if (scene.name == "andy") add_counts(modes);
  if (scene.name == "dress") {
    add_large_steps(modes);
    add_time_steps(modes, scene, stretch);
  }

  modes.push_back({kOwnMode, stretch.steps});
  return modes;
}

}  // namespace icloth
