#include "app/common/options.h"

#include <cmath>
#include <cstdlib>

#include "app/common/machine.h"
#include "sim/cuda_devices.h"
#include "sim/files/error.h"

namespace icloth {
namespace {

constexpr long kMostSteps = 100'000'000;

/// The word in single quotes where a shell would otherwise change it.
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

std::vector<std::string> scene_overrides(const SimulationOptions& options) {
  std::vector<std::string> overrides;
  if (!options.preset.empty()) overrides.push_back("preset=" + options.preset);
  if (options.repair_start) overrides.emplace_back("repair_start=on");
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return overrides;
}

SceneLimits scene_limits(const SimulationOptions& options) {
  SceneLimits limits;
  limits.allow_outside = options.allow_outside;
  return limits;
}

Build choose_build(const SimulationOptions& options) {
  // Double precision is there on the CPU only.
  const bool cuda = options.device.starts_with("cuda");
  if (options.precision == "f64") {
    if (cuda) throw InputError("--precision f64: expected --device cpu with it");
    return Build::cpu64;
  }

  if (options.device == "cpu") return Build::cpu32;

  // A numbered device has to work; without a number the first usable one is taken.
  std::string reason;
  if (options.device.starts_with("cuda:")) {
    set_cuda_device(std::atoi(options.device.c_str() + 5));
    if (build_available(Build::cuda32, &reason)) return Build::cuda32;
  } else if (choose_first_cuda_device(reason)) {
    return Build::cuda32;
  }

  // Only a device that was asked for is missed.
  if (cuda) throw DeviceError("--device " + options.device + ": " + reason);
  return Build::cpu32;
}

long step_count(const SimulationOptions& options, const Scene& scene) {
  if (options.steps >= 0) return options.steps;
  const double time = options.time >= 0 ? options.time : scene.duration;
  return std::lround(std::min(time / scene.parameters.step.time_step, double(kMostSteps)));
}

int solver_threads(const SimulationOptions& options) {
  return options.threads > 0 ? options.threads : processor_threads();
}

std::string command_arguments(const SimulationOptions& options, Build build) {
  std::string text = quoted(options.scene);
  text += build == Build::cuda32 ? " --device cuda" : " --device cpu";
  if (build == Build::cpu64) text += " --precision f64";
  if (options.allow_outside) text += " --allow-outside";
  for (const std::string& override : scene_overrides(options)) text += " --set " + quoted(override);
  return text;
}

}  // namespace icloth
