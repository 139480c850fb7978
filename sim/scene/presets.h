// Settings for users who want speed or accuracy without knowing the parameters: points on the
// fronts that `icloth bench accuracy` measures.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "sim/scene/parameters.h"

namespace icloth {

struct Preset {
  using Setting = std::pair<std::string_view, std::string_view>;  ///< parameter, value

  std::string_view name;   ///< "fast"
  std::string_view label;  ///< "Fast"
  std::span<const Setting> settings;
  std::string_view purpose;  ///< a sentence
};

/// From the fastest to the most accurate; all set the same parameters.
std::span<const Preset> presets();

/// The results of `icloth bench accuracy` for a preset, one line a scene, and the machine they were
/// measured on. They are read from assets/results/presets.json, which docs/make_tables.py makes
/// from the recorded results. Empty where that file is missing or cannot be read.
std::string measured_results(const Preset& preset);

/// Throws InputError that names the presets.
const Preset& find_preset(std::string_view name);

/// Ways of handling collisions to compare with: that of this program, and those of two earlier
/// simulators as far as its stages reach. `--set mode=NAME` chooses one.
std::span<const Preset> collision_modes();

/// Throws InputError that names the modes.
const Preset& find_collision_mode(std::string_view name);

void apply_preset(Parameters& parameters, const Preset& preset);
/// Whether the parameters have all of its values.
bool is_set(const Parameters& parameters, const Preset& preset);

}  // namespace icloth
