// icloth render: pictures without a display.
#pragma once

#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth {

struct RenderOptions {
  std::string scene = "scarf";         ///< built-in name, scene JSON or mesh file
  std::vector<std::string> overrides;  ///< --set arguments, "KEY=VALUE"
  Build build = Build::cpu32;
  int threads = 0;  ///< of the CPU builds; 0: all
  bool quiet = false;

  long steps = -1;                ///< simulated before the picture; -1: by time
  double time = -1;               ///< [s]; -1 (and steps -1): the scene's duration
  std::string size = "1280x720";  ///< WIDTHxHEIGHT
  std::string camera;             ///< name in the scene, or FILE.json; empty: the first
  std::string view = "shaded";
  std::string quality = "still";   ///< draft, interactive or still
  std::string vertices = "auto";   ///< way to the GPU: auto, interop or host
  std::string out = "icloth.png";  ///< FILE.png, or FILE.mp4 for a video of the whole run
  double frame_rate = 25;          ///< of the video [1/s]
  std::string stats_file;          ///< step statistics, .csv or .json; empty: none
};

/// Simulates without a display and writes the picture or video. Returns the exit code: 0, or 1 when
/// a step was refused. Throws InputError, and DeviceError when no OpenGL is there or --vertices
/// interop cannot be had.
int run_render(const RenderOptions& options);

}  // namespace icloth
