// The options of the window on the command line.
#pragma once

#include <string>
#include <vector>

#include "app/common/options.h"
#include "sim/scene/input.h"

namespace icloth {

struct ViewOptions {
  SimulationOptions simulation;
  std::string record_file;        ///< the session is written here at the end; empty: only Ctrl+S
  std::string screenshot_folder;  ///< F12 writes here; empty: the current folder
  std::string vertices = "auto";  ///< upload path of vertices: auto or host
  bool choose = false;            ///< ask for a scene before the first one is opened
  std::vector<Recording::Step> recorded;  ///< a run of the scene, to be made again at the start
  bool play = true;                       ///< start running
  bool play_script = false;               ///< apply the scene's scripted grabs as well
  int width = 1280, height = 800;
};

}  // namespace icloth
