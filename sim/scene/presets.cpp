#include "sim/scene/presets.h"

#include <algorithm>
#include <string>

#include "sim/files/error.h"

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
    {"fast", "Fast", kFast,
     "For looking: 1.3 (flag) to 2.1 times (sphere) as fast as the built-in scenes' own settings. "
     "Vertices are 33 mm (flag) and 15 mm (sphere) from a reference with a step of 1/1600 s, "
     "energies 20 %; with the scenes' own settings 27 and 9 mm, 13 and 18 %."},
    {"normal", "Normal", kNormal,
     "1.0 (flag) to 1.4 times (sphere) as fast as the built-in scenes' own settings, and nearer "
     "to a reference with a step of 1/1600 s: vertices are 22 mm (flag) and 6 mm (sphere) away, "
     "energies 13 and 7 %. With the scenes' own settings: 27 and 9 mm, 13 and 18 %."},
    {"accurate", "Accurate", kAccurate,
     "For measuring: a third (flag) to a half (sphere) as fast as the built-in scenes' own "
     "settings. Vertices are 6 mm (flag) and 2 mm (sphere) from a reference with a step of "
     "1/1600 s, energies 2 %; with the scenes' own settings 27 and 9 mm, 13 and 18 %."},
};

}  // namespace

std::span<const Preset> presets() { return kPresets; }

const Preset& find_preset(std::string_view name) {
  std::string names;
  for (const Preset& preset : kPresets) {
    if (preset.name == name) return preset;
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw InputError("preset '" + std::string(name) + "', expected one of " + names);
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
