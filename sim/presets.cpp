#include "sim/presets.h"

#include <algorithm>
#include <string>

#include "sim/error.h"

namespace icloth {
namespace {

// Two-step steps lie on the fronts of all scenes; which length and tolerance is a matter of taste.
constexpr Preset::Setting kFast[] = {{"step.time_step", "0.02"},
                                     {"implicit.integrator", "bdf2"},
                                     {"implicit.cg_tolerance", "0.05"},
                                     {"implicit.newton_iterations", "3"}};
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
     "For looking: 1.3 to 3 times as fast as the built-in scenes' own settings. Vertices are 37 mm "
     "(flag), "
     "23 mm (scarf), 17 mm (sphere, drape) from a reference with a step of 1/1600 s; own settings: "
     "27, 10, 9, 11 mm."},
    {"normal", "Normal", kNormal,
     "About as fast as the built-in scenes' own settings, sphere 1.6 times. Vertices are 22 mm "
     "(flag), 10 mm (scarf), 7 mm "
     "(sphere), 12 mm (drape) from a reference with a step of 1/1600 s, energies 3 to 13 %; own "
     "settings: 27, 10, 9, 11 mm, 10 to 18 %."},
    {"accurate", "Accurate", kAccurate,
     "For measuring: a third to a half as fast as the built-in scenes' own settings. Vertices are "
     "6 mm (flag), 4 mm (scarf), "
     "2 mm (sphere), 11 mm (drape, where folds decide) from a reference with a step of 1/1600 s, "
     "energies 2 to 5 %."},
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
