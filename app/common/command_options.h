// The options of SimulationOptions on the command line. CLI11 takes long to compile: the one source
// file of a program that reads the command line includes this, no other.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "app/common/options.h"
#include "sim/files/text.h"

namespace icloth {

inline constexpr double kLongestTime = 1e5;  ///< of --time [s]

/// Checks the form of a device. An empty text means that it is right.
inline std::string check_device(const std::string& text) {
  const bool numbered = text.starts_with("cuda:") && text.size() > 5 && text.size() < 9 &&
                        text.find_first_not_of("0123456789", 5) == std::string::npos;
  if (text == "cpu" || text == "cuda" || numbered) return "";
  return in_quotes(text) + ", expected cpu, cuda or cuda:N";
}

/// Checks seconds by itself, since CLI::Range lets NaN through.
inline std::string check_time(const std::string& text) {
  char* end = nullptr;
  const double time = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && time >= 0 && time <= kLongestTime) return "";
  return in_quotes(text) + ", expected seconds from 0 to 100000";
}

/// Adds --device to a command; its form is checked while the command line is read.
inline void add_device_option(CLI::App& command, std::string& device) {
  command.add_option("--device", device, "cpu, cuda or cuda:N (default: cuda where usable)")
      ->check(check_device);
}

/// Adds --allow-outside to a command that opens a scene.
inline void add_outside_option(CLI::App& command, bool& allow_outside) {
  command.add_flag("--allow-outside", allow_outside,
                   "let the scene open files outside its folder and the program's assets");
}

/// Adds the options to a command; values are checked while the command line is read.
inline void add_simulation_options(CLI::App& command, SimulationOptions& options,
                                   bool scene_required) {
  // A command names a scene and a device.
  auto* scene = command.add_option(
      "SCENE", options.scene,
      "built-in name (scarf sphere twisting funnel dress tiered andy bishop dressed drape flag), "
      "scene JSON or mesh file");
  if (scene_required) scene->required();
  add_device_option(command, options.device);
  command.add_option("--precision", options.precision, "f32 or f64 (f64: cpu only)")
      ->check(CLI::IsMember({"f32", "f64"}));
  command.add_option("--threads", options.threads, "threads of the CPU solver (default: all)")
      ->check(CLI::Range(1, 4096));

  // The length of the run, either in steps or in seconds.
  auto* steps = command.add_option("--steps", options.steps, "number of steps")
                    ->check(CLI::Range(0L, 100'000'000L));
  command.add_option("--time", options.time, "simulated seconds (default: the scene's duration)")
      ->check(check_time)
      ->excludes(steps);

  // A scene comes from anyone; changes of it and of its parameters come from the user.
  add_outside_option(command, options.allow_outside);
  command.add_flag("--repair-start", options.repair_start,
                   "separate faces that intersect a little at the start");
  command.add_option("--preset", options.preset,
                     "fast, normal or accurate: settings measured by bench accuracy");
  command.add_option("--set", options.overrides, "KEY=VALUE: a parameter by its dotted name")
      ->allow_extra_args(false);

  command.add_flag("--dump-config", options.dump_config, "print all parameters as JSON and stop");
  command.add_flag("--quiet", options.quiet, "print errors only");
}

}  // namespace icloth
