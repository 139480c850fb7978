// What the window was asked for on the command line.
#pragma once

#include <string>
#include <vector>

#include "sim/simulator.h"

namespace icloth {

struct ViewOptions {
  std::string scene = "scarf";         ///< built-in name, scene JSON or mesh file
  std::vector<std::string> overrides;  ///< --set arguments, "KEY=VALUE"
  Build build = Build::cpu32;
  int threads = 0;                ///< of the CPU builds; 0: all but the one that draws
  std::string record_file;        ///< the session is written here at the end; empty: only Ctrl+S
  std::string screenshot_folder;  ///< where F12 writes; empty: the current folder
  std::string vertices = "auto";  ///< way to the GPU: auto or host
  bool play = true;               ///< start running
  bool play_script = false;       ///< apply the scene's scripted grabs as well
  int width = 1280, height = 800;
};

}  // namespace icloth
