// The state of the window as its tests read it: one JSON line, written anew every second.
#pragma once

#include <array>
#include <string>

#include "kernels/vec.h"

namespace icloth {

/// The numbers of the line.
struct TestStatus {
  std::string phase = "running";  ///< "opening" while a scene is dressed, "choosing" before one
  double clock = 0;               ///< of the window [s]
  int dressing_step = 0;
  long long step = 0;
  double time = 0;
  long long penetrations = 0;
  double max_speed = 0;  ///< [m/s]
  double ui_fps = 0, steps_per_second = 0;
  int handles = 0, parked = 0;
  int notes = 0;  ///< about the input of the scene
  double body_speed = 1;
  std::string garments;  ///< in one line; empty: none
  bool playing = false, failed = false, panels = true;
  std::array<float, 4> view{};  ///< left, top, width, height of the 3D picture [logical pixels]
  Vec3d eye;                    ///< of the camera [m]
  Vec3d mean;                   ///< of the cloth's vertices [m]
  bool cloth_visible = false;
  double cloth_x = 0, cloth_y = 0;  ///< a point of the window where the cloth can be grabbed
};

/// Writes to the file that the environment variable ICLOTH_TEST_STATUS names, if any.
class TestStatusFile {
 public:
  TestStatusFile();
  bool wanted() const { return !path_.empty(); }
  /// Replaces the file at once: a reader never sees half a line.
  void write(const TestStatus& status) const;

 private:
  std::string path_;
};

}  // namespace icloth
