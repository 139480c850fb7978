// icloth render: pictures without a display.
#pragma once

#include <string>

#include "app/common/options.h"

namespace icloth {

struct RenderOptions {
  SimulationOptions simulation;   ///< the run that leads to the picture
  std::string size = "1280x720";  ///< WIDTHxHEIGHT
  std::string camera;             ///< name in the scene, or FILE.json; empty: the first
  std::string view = "shaded";
  std::string quality = "still";   ///< draft, interactive or still
  std::string vertices = "auto";   ///< upload path of vertices: auto, interop or host
  std::string out = "icloth.png";  ///< FILE.png
  std::string stats_file;          ///< step statistics, .csv or .json; empty: none
};

/// Simulates without a display and writes the picture. Returns the exit code: 0, or 1 when a step
/// was refused. Throws InputError, and DeviceError when no OpenGL is there or --vertices interop
/// cannot be had.
int run_render(const RenderOptions& options);

}  // namespace icloth
