#include "sim/scene/parameters.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/text.h"

using namespace icloth;

namespace {

std::string error_of(std::string_view key, std::string_view value) {
  Parameters parameters;
  try {
    set_parameter(parameters, key, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST(Parameters, TableCoversEveryMemberOnce) {
  // Every member is a double, an int or a bool; rows must reach all of them, none twice.
  std::set<std::string_view> names;
  std::size_t bytes = 0;
  for (const ParameterInfo& info : parameter_table()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    using Kind = ParameterInfo::Kind;
    Parameters parameters;
    info.field.set(parameters, get_parameter(parameters, info) == 0 ? 1 : 0);
    int changed = 0;
    for (const ParameterInfo& other : parameter_table())
      changed += get_parameter(parameters, other) != get_parameter(Parameters{}, other);
    EXPECT_EQ(changed, 1) << info.name;
    const Kind kind = info.field.kind;
    bytes += kind == Kind::number    ? sizeof(double)
             : kind == Kind::boolean ? sizeof(bool)
                                     : sizeof(int);
    EXPECT_EQ(info.field.choices.empty(), kind != Kind::choice) << info.name;
  }
  EXPECT_GE(names.size(), 33u);
  EXPECT_LE(bytes, sizeof(Parameters));
  EXPECT_GE(bytes + 48, sizeof(Parameters)) << "a member has no row (or much padding)";
}

TEST(Parameters, DefaultsLieInTheirRanges) {
  for (const ParameterInfo& info : parameter_table()) {
    const double value = get_parameter(Parameters{}, info);
    EXPECT_LE(info.minimum, value) << info.name;
    EXPECT_GE(info.maximum, value) << info.name;
    EXPECT_FALSE(info.label.empty() || info.lower.empty() || info.higher.empty()) << info.name;
    EXPECT_FALSE(info.source.empty()) << info.name;
    EXPECT_TRUE(!info.logarithmic || info.minimum > 0) << info.name;
  }
}

TEST(Parameters, SetByNameAndAlias) {
  Parameters parameters;
  set_parameter(parameters, "step.time_step", "0.005");
  EXPECT_EQ(parameters.step.time_step, 0.005);
  set_parameter(parameters, "time_step", "1e-2");
  EXPECT_EQ(parameters.step.time_step, 0.01);
  set_parameter(parameters, "mu", "500");
  EXPECT_EQ(parameters.impact_zones.penalty, 500);
  set_parameter(parameters, "rho", "0.9");
  EXPECT_EQ(parameters.impact_zones.rho, 0.9);
  set_parameter(parameters, "impact_zones.chebyshev", "off");
  EXPECT_FALSE(parameters.impact_zones.chebyshev);
  set_parameter(parameters, "impact_zones.chebyshev", "1");
  EXPECT_TRUE(parameters.impact_zones.chebyshev);
  set_parameter(parameters, "implicit.cg_max_iterations", "77");
  EXPECT_EQ(parameters.implicit.cg_max_iterations, 77);
}

TEST(Parameters, ReadsTheEarlierNameOfARenamedParameter) {
  Parameters parameters;
  set_parameter(parameters, "implicit.max_missed_tension", "123");
  EXPECT_EQ(parameters.implicit.max_linearization_error, 123);
  EXPECT_EQ(find_parameter("implicit.max_missed_tension"),
            find_parameter("implicit.max_linearization_error"));
}

TEST(Parameters, RefusesBadValuesWithOneLine) {
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"time_step", "0"},
           {"time_step", "-0.01"},
           {"time_step", "nan"},
           {"time_step", "inf"},
           {"time_step", "0.01x"},
           {"time_step", ""},
           {"time_step", " 0.01"},
           {"step.max_substep_levels", "2.5"},
           {"step.max_substep_levels", "99999999999999999999"},
           {"impact_zones.enabled", "2"},
           {"impact_zones.enabled", "maybe"},
           {"impact_zones.rho", "1"},
           {"proximity.thickness", "-1"}}) {
    const std::string message = error_of(key, value);
    EXPECT_TRUE(contains(message, "expected")) << key << "=" << value << ": " << message;
    EXPECT_TRUE(contains(message, "'" + value + "'") || value == "99999999999999999999") << message;
    EXPECT_FALSE(contains(message, "\n"));
  }
  EXPECT_TRUE(contains(error_of("time_step", "0"), "step.time_step"));
  EXPECT_TRUE(contains(error_of("time_step", "0"), "1e-04 to 0.1 s")) << error_of("time_step", "0");
}

TEST(Parameters, UnknownKeyNamesTheNearest) {
  EXPECT_TRUE(contains(error_of("step.timestep", "1"), "'step.time_step'"));
  EXPECT_TRUE(contains(error_of("thicknes", "1"), "'proximity.thickness'"));
  EXPECT_TRUE(contains(error_of("impact_zone.penalty", "1"), "'impact_zones.penalty'"));
  const std::string_view words[] = {"alpha", "beta", "gamma"};
  EXPECT_EQ(nearest_name("bata", words), "beta");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(Parameters, ValueIsKeptWhenRefused) {
  Parameters parameters;
  EXPECT_THROW(set_parameter(parameters, "time_step", "7"), InputError);
  EXPECT_EQ(parameters.step.time_step, Parameters{}.step.time_step);
}

TEST(Parameters, DumpReadsBack) {
  Parameters parameters;
  parameters.step.time_step = 0.1 / 3;
  parameters.impact_zones.max_rounds = 7;
  parameters.impact_zones.chebyshev = false;
  parameters.impact_zones.solver = ZoneSolver::linear;
  const auto json = nlohmann::json::parse(dump_parameters(parameters));
  EXPECT_EQ(json.size(), parameter_table().size());
  Parameters copy;
  for (const auto& [name, value] : json.items())
    set_parameter(copy, name, value.is_string() ? value.get<std::string>() : value.dump());
  for (const ParameterInfo& info : parameter_table())
    EXPECT_EQ(get_parameter(copy, info), get_parameter(parameters, info)) << info.name;
}

TEST(Parameters, ChoicesAreGivenByName) {
  Parameters parameters;
  set_parameter(parameters, "impact_zones.solver", "dual");
  EXPECT_EQ(parameters.impact_zones.solver, ZoneSolver::dual);
  const ParameterInfo& penalty = *find_parameter("impact_zones.penalty");
  EXPECT_FALSE(parameter_used(parameters, penalty));
  set_parameter(parameters, "impact_zones.solver", "augmented_lagrangian");
  EXPECT_TRUE(parameter_used(parameters, penalty));
  for (const char* wrong : {"", "Dual", "1", "dual "}) {
    try {
      set_parameter(parameters, "impact_zones.solver", wrong);
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("one of augmented_lagrangian dual linear"),
                std::string::npos)
          << error.what();
    }
  }
}
