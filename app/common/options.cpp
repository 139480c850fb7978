#include "app/common/options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>

#include "sim/cuda_devices.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

constexpr long kMostSteps = 100'000'000;
constexpr int kMostThreads = 4096;
constexpr double kLongestTime = 1e5;  // [s]

std::string check_device(const std::string& text) {
  const bool numbered = text.starts_with("cuda:") && text.size() > 5 && text.size() < 9 &&
                        text.find_first_not_of("0123456789", 5) == std::string::npos;
  if (text == "cpu" || text == "cuda" || numbered) return "";
  return "'" + text + "', expected cpu, cuda or cuda:N";
}

/// CLI::Range lets NaN through.
std::string check_time(const std::string& text) {
  char* end = nullptr;
  const double time = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && time >= 0 && time <= kLongestTime) return "";
  return "'" + text + "', expected seconds from 0 to 100000";
}

/// In single quotes where a shell would otherwise change the word.
std::string quoted(const std::string& word) {
  static constexpr char kPlain[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,+-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Makes the first usable CUDA device the one that is used; otherwise `reason` says why there is
/// none.
bool choose_first_cuda_device(std::string& reason) {
  const int count = cuda_device_count(&reason);
  for (int ordinal = 0; ordinal < count; ++ordinal) {
    std::string problem;
    if (cuda_device_usable(ordinal, &problem)) {
      set_cuda_device(ordinal);
      return true;
    }
    reason += (ordinal > 0 ? "; " : "") + problem;
  }
  return false;
}

}  // namespace

void add_device_option(CLI::App& verb, std::string& device) {
  verb.add_option("--device", device, "cpu, cuda or cuda:N (default: cuda where usable)")
      ->check(check_device);
}

void add_simulation_options(CLI::App& verb, SimulationOptions& options, bool scene_required) {
  auto* scene =
      verb.add_option("SCENE", options.scene,
                      "built-in name (scarf sphere twisting funnel drape flag), scene JSON or mesh "
                      "file");
  if (scene_required) scene->required();
  add_device_option(verb, options.device);
  verb.add_option("--precision", options.precision, "f32 or f64 (f64: cpu only)")
      ->check(CLI::IsMember({"f32", "f64"}));
  verb.add_option("--threads", options.threads, "threads of the CPU solver (default: all)")
      ->check(CLI::Range(1, kMostThreads));
  auto* steps = verb.add_option("--steps", options.steps, "number of steps")
                    ->check(CLI::Range(0L, kMostSteps));
  verb.add_option("--time", options.time, "simulated seconds (default: the scene's duration)")
      ->check(check_time)
      ->excludes(steps);
  verb.add_flag("--repair-start", options.repair_start,
                "separate faces that intersect a little at the start");
  verb.add_option("--preset", options.preset,
                  "fast, normal or accurate: settings measured by bench accuracy");
  verb.add_option("--set", options.overrides, "KEY=VALUE: a parameter by its dotted name")
      ->allow_extra_args(false);
  verb.add_flag("--dump-config", options.dump_config, "print all parameters as JSON and stop");
  verb.add_flag("--quiet", options.quiet, "print errors only");
}

std::vector<std::string> scene_overrides(const SimulationOptions& options) {
  std::vector<std::string> overrides;
  if (!options.preset.empty()) overrides.push_back("preset=" + options.preset);
  if (options.repair_start) overrides.emplace_back("repair_start=on");
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return overrides;
}

Build choose_build(const SimulationOptions& options) {
  const bool cuda = options.device.starts_with("cuda");
  if (options.precision == "f64") {
    if (cuda) throw InputError("--precision f64: expected --device cpu with it");
    return Build::cpu64;
  }
  if (options.device == "cpu") return Build::cpu32;
  std::string reason;
  if (options.device.starts_with("cuda:")) {
    set_cuda_device(std::atoi(options.device.c_str() + 5));
    if (build_available(Build::cuda32, &reason)) return Build::cuda32;
  } else if (choose_first_cuda_device(reason)) {
    return Build::cuda32;
  }
  if (cuda) throw DeviceError("--device " + options.device + ": " + reason);
  return Build::cpu32;
}

long step_count(const SimulationOptions& options, const Scene& scene) {
  if (options.steps >= 0) return options.steps;
  const double time = options.time >= 0 ? options.time : scene.duration;
  return std::lround(std::min(time / scene.parameters.step.time_step, double(kMostSteps)));
}

std::string command_arguments(const SimulationOptions& options, Build build) {
  std::string text = quoted(options.scene);
  text += build == Build::cuda32 ? " --device cuda" : " --device cpu";
  if (build == Build::cpu64) text += " --precision f64";
  for (const std::string& override : scene_overrides(options)) text += " --set " + quoted(override);
  return text;
}

}  // namespace icloth
