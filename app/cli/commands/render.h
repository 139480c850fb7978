// icloth render: pictures and videos without a display.
#pragma once

#include <string>

#include "app/common/options.h"

namespace icloth {

struct RenderOptions {
  SimulationOptions simulation;  ///< the run that leads to the picture
  std::string size;    ///< WIDTHxHEIGHT; empty: that of the golden picture, or 1280x720 without one
  std::string camera;  ///< name in the scene, or FILE.json; empty: the first
  std::string view = "shaded";
  bool legend = true;   ///< of the colours of the view, where they have a meaning
  std::string quality;  ///< draft, interactive or still; empty: still, for videos interactive
  std::string vertices = "auto";       ///< upload path of vertices: auto, interop or host
  std::string out = "icloth.png";      ///< FILE.png, or FILE.mp4 for a video of the whole run
  int frames_per_second = 30;          ///< of a video, which plays at the speed of the simulation
  std::string stats_file;              ///< step statistics, .csv or .json; empty: none
  std::string golden;                  ///< picture to compare with, FILE.png; empty: none
  bool update = false;                 ///< write that picture anew in place of the comparison
  std::string tolerance = "software";  ///< of the comparison: exact, software or device
};

/// Simulates without a display and writes the picture or the video. Returns the exit code: 0, or 1
/// when a step was refused or the picture is not the golden one. Throws InputError, and DeviceError
/// when no OpenGL is there or --vertices interop cannot be had.
int run_render(const RenderOptions& options);

}  // namespace icloth
