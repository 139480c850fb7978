#include "sim/scene/presets.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/files/assets.h"
#include "sim/files/error.h"
#include "sim/files/json_reader.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

// Points of bench accuracy, each on the fronts of two or three scenes (docs/accuracy.md).
constexpr Preset::Setting kFast[] = {{"step.time_step", "0.02"},
                                     {"implicit.integrator", "backward_euler"},
                                     {"implicit.cg_tolerance", "0.02"},
                                     {"implicit.newton_iterations", "5"}};
constexpr Preset::Setting kNormal[] = {{"step.time_step", "0.01"},
                                       {"implicit.integrator", "bdf2"},
                                       {"implicit.cg_tolerance", "0.01"},
                                       {"implicit.newton_iterations", "3"}};
constexpr Preset::Setting kAccurate[] = {{"step.time_step", "0.0025"},
                                         {"implicit.integrator", "bdf2"},
                                         {"implicit.cg_tolerance", "0.001"},
                                         {"implicit.newton_iterations", "5"}};

constexpr Preset kPresets[] = {
    {"fast", "Fast", kFast, "For looking: larger steps, solved less exactly."},
    {"normal", "Normal", kNormal, "Nearer to the exact motion than the defaults, about as fast."},
    {"accurate", "Accurate", kAccurate, "For measuring: small steps of second order."},
};

// Tang et al. 2018 (PSCC) and 2016 (CAMA) are compared with by Section 5.3. Both test all pairs in
// every round, and both are taken to respond by the linear impact zones of Harmon et al. 2008.
// Without late contacts, shorter substeps are faster.
constexpr Preset::Setting kOwn[] = {{"step.max_travel", "10"},
                                    {"proximity.late_rounds", "2"},
                                    {"broad_phase.method", "tree"},
                                    {"ccd.incremental", "on"},
                                    {"impact_zones.solver", "dual"}};
constexpr Preset::Setting kPscc[] = {{"step.max_travel", "2"},
                                     {"proximity.late_rounds", "0"},
                                     {"broad_phase.method", "hash"},
                                     {"ccd.incremental", "off"},
                                     {"impact_zones.solver", "linear"}};
constexpr Preset::Setting kCama[] = {{"step.max_travel", "2"},
                                     {"proximity.late_rounds", "0"},
                                     {"broad_phase.method", "tree"},
                                     {"ccd.incremental", "off"},
                                     {"impact_zones.solver", "linear"}};

constexpr Preset kModes[] = {
    {"icloth", "icloth", kOwn,
     "Trees, incremental rounds, late contacts, non-linear impact zones: the defaults."},
    {"pscc", "PSCC-style, our implementation", kPscc,
     "Spatial hashing, all pairs in every round, linear impact zones."},
    {"cama", "CAMA-style, our implementation", kCama,
     "Trees, all pairs in every round, linear impact zones."},
};

/// The entry of that name; `what` stands for it in the message where there is none.
const Preset& find_named(std::span<const Preset> list, std::string_view name, const char* what) {
  std::string names;
  for (const Preset& preset : list) {
    if (preset.name == name) return preset;
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw InputError(what + (" " + in_quotes(name)) + ", expected one of " + names);
}

/// One measured point of a scene.
std::string line_of(const nlohmann::json& point, const nlohmann::json& own) {
  char text[160];
  std::snprintf(
      text, sizeof text, "%.16s: %.3g times as fast, %.3g mm off (own settings %.3g mm)\n",
      point.at("scene").get<std::string>().c_str(), point.at("times_faster").get<double>(),
      point.at("position_mm").get<double>(), own.at("position_mm").get<double>());
  return text;
}

}  // namespace

std::span<const Preset> presets() { return kPresets; }

std::string measured_results(const Preset& preset) {
  try {
    const nlohmann::json file = read_json(assets_folder() + "/results/presets.json");
    const nlohmann::json& points = file.at("presets").at(std::string(preset.name));
    const nlohmann::json& own = file.at("presets").at("as in the scene");

    std::string text;
    for (std::size_t k = 0; k < points.size(); ++k) text += line_of(points.at(k), own.at(k));
    return text + "(" + file.at("source").get<std::string>() + ")";
  } catch (const std::exception&) {
    return "";  // A program without its results works; it has nothing to show here.
  }
}

const Preset& find_preset(std::string_view name) { return find_named(kPresets, name, "preset"); }

std::span<const Preset> collision_modes() { return kModes; }

const Preset& find_collision_mode(std::string_view name) {
  return find_named(kModes, name, "mode");
}

void apply_preset(Parameters& parameters, const Preset& preset) {
  for (const auto& [key, value] : preset.settings) set_parameter(parameters, key, value);
}

bool is_set(const Parameters& parameters, const Preset& preset) {
  Parameters wanted = parameters;
  apply_preset(wanted, preset);
  return std::ranges::all_of(parameter_table(), [&](const ParameterInfo& info) {
    return get_parameter(wanted, info) == get_parameter(parameters, info);
  });
}

}  // namespace icloth
