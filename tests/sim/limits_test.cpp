// Every limit of a step, reached by a setting that is too tight for the scene, and not reached by a
// wide one: the report of the step says so in both cases.
#include <gtest/gtest.h>

#include <ostream>

#include "sim/scene/scene_io.h"
#include "sim/simulator.h"

namespace icloth {
namespace {

struct LimitCase {
  const char* name;
  Limit limit;
  std::vector<std::string> scene;  ///< settings of both runs
  std::vector<std::string> tight, wide;
  int steps = 8;
};

void PrintTo(const LimitCase& given, std::ostream* out) { *out << given.name; }

/// Impacts are many where cloth falls fast and nothing repels it.
const std::vector<std::string> kImpacts = {"gravity.y=-100", "proximity.enabled=false"};

const LimitCase kCases[] = {
    {"SubstepLevels",
     Limit::substep_levels,
     {"gravity.y=-100"},
     {"step.max_substep_levels=0", "step.max_travel=0.1"},
     {"step.max_substep_levels=10", "step.max_travel=1"}},
    {"LinearizationError",
     Limit::linearization_error,
     {"gravity.y=-100"},
     {"implicit.max_linearization_error=1", "implicit.newton_iterations=1"},
     {"implicit.max_linearization_error=1e9"}},
    {"NewtonIterations",
     Limit::newton_iterations,
     {},
     {"implicit.newton_iterations=1", "implicit.newton_tolerance=1e-3"},
     {"implicit.newton_iterations=20", "implicit.newton_tolerance=100"},
     16},
    {"ContactPasses",
     Limit::contact_passes,
     {},
     {"implicit.contact_passes=1", "implicit.contact_tolerance=1e-3"},
     {"implicit.contact_passes=20", "implicit.contact_tolerance=1"},
     16},
    {"CgIterations",
     Limit::cg_iterations,
     {},
     {"implicit.cg_max_iterations=1"},
     {"implicit.cg_max_iterations=5000"}},
    {"ZoneIterations",
     Limit::zone_iterations,
     kImpacts,
     {"impact_zones.iterations=1"},
     {"impact_zones.iterations=10000"}},
    {"ZoneRounds",
     Limit::zone_rounds,
     kImpacts,
     {"impact_zones.max_rounds=1"},
     {"impact_zones.max_rounds=1000", "impact_zones.max_correction=100"}},
    {"ZoneCorrection",
     Limit::zone_correction,
     kImpacts,
     {"impact_zones.max_correction=0.1", "step.max_travel=100"},
     {"impact_zones.max_correction=100"}},
    {"HandSpeed", Limit::hand_speed, {}, {"grab.max_speed=0.1"}, {"grab.max_speed=20"}, 14},
    {"HandForce", Limit::hand_force, {}, {"grab.max_force=0.01"}, {"grab.max_force=1000"}, 14},
};

/// All limits that a run with these settings reaches, a bit each.
std::int64_t limits_of_run(Build build, const LimitCase& given,
                           const std::vector<std::string>& more) {
  std::vector<std::string> settings = given.scene;
  settings.insert(settings.end(), more.begin(), more.end());
  const auto scene = load_scene(std::string(ICLOTH_TEST_FOLDER) + "/data/drop.json", settings);
  const auto simulator = make_simulator(build, scene);

  // The scene's hand takes part, as in a headless run.
  ScriptedInput script(*scene);
  std::int64_t limits = 0;
  for (int k = 0; k < given.steps; ++k)
    limits |=
        simulator->step(script.events(simulator->time(), scene->parameters.step.time_step)).limits;
  return limits;
}

class Limits : public ::testing::TestWithParam<LimitCase> {};

TEST_P(Limits, AreSaidWhereTheyAreReachedAndOnlyThere) {
  const LimitCase& given = GetParam();
  for (const Build build : {Build::cpu32, Build::cpu64}) {
    EXPECT_NE(limits_of_run(build, given, given.tight) & bit_of(given.limit), 0);
    EXPECT_EQ(limits_of_run(build, given, given.wide) & bit_of(given.limit), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(OfAStep, Limits, ::testing::ValuesIn(kCases),
                         [](const auto& given) { return std::string(given.param.name); });

TEST(LimitNames, AreParametersInTheOrderOfTheirBits) {
  const Parameters parameters;
  for (int k = 0; k < kLimitCount; ++k) {
    const auto limit = static_cast<Limit>(k);
    const auto names = names_of_limits(bit_of(limit));
    ASSERT_EQ(names.size(), 1u);
    EXPECT_EQ(names[0], parameter_of(limit));
    EXPECT_NE(find_parameter(names[0]), nullptr) << names[0];
  }
  EXPECT_TRUE(names_of_limits(0).empty());
  EXPECT_EQ(names_of_limits(bit_of(Limit::hand_force) | bit_of(Limit::cg_iterations)),
            (std::vector<std::string_view>{"implicit.cg_max_iterations", "grab.max_force"}));
}

}  // namespace
}  // namespace icloth
