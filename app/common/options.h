// Options that every simulating command has.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/scene_io.h"
#include "sim/simulator.h"

namespace icloth {

struct SimulationOptions {
  std::string scene = "scarf";    ///< built-in name, scene JSON or mesh file
  std::string device;             ///< cpu, cuda or cuda:N; empty: cuda where it is usable
  std::string precision = "f32";  ///< f32 or f64
  int threads = 0;                ///< of the CPU builds; 0: all
  long steps = -1;                ///< -1: by time
  double time = -1;               ///< [s]; -1 (and steps -1): the scene's duration
  std::string preset;             ///< name of a preset, sim/scene/presets.h; empty: none
  bool repair_start = false;
  bool allow_outside = false;          ///< the scene may name files outside its folder
  std::vector<std::string> overrides;  ///< --set arguments, "KEY=VALUE"
  bool dump_config = false;            ///< print all parameters and stop
  bool quiet = false;
};

/// The changes of the scene by the options, for load_scene: the preset first, then each --set.
std::vector<std::string> scene_overrides(const SimulationOptions& options);

/// What the scene may ask for.
SceneLimits scene_limits(const SimulationOptions& options);

/// The build that --device and --precision ask for. `cuda` and an empty device mean the first CUDA
/// device that can be used, `cuda:N` that one; it becomes the one of Build::cuda32
/// (set_cuda_device). Throws InputError (cuda with f64), DeviceError when a CUDA device was asked
/// for and none can be used.
Build choose_build(const SimulationOptions& options);

/// The number of steps that --steps, --time or the scene's duration ask for, at the scene's time
/// step.
long step_count(const SimulationOptions& options, const Scene& scene);

/// The threads of the CPU builds: those of --threads, else all that there are.
int solver_threads(const SimulationOptions& options);

/// The options as they would be typed, without the command: "scarf --device cpu --set mu=500".
/// `build` replaces --device and --precision, so that the line repeats on other machines.
std::string command_arguments(const SimulationOptions& options, Build build);

}  // namespace icloth
