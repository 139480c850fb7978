// What a hand does to the cloth: the same events come from the mouse, a scene and a recording.
#pragma once

#include <string>
#include <vector>

#include "kernels/vec.h"
#include "sim/scene/parameters.h"
#include "sim/scene/scene.h"

namespace icloth {

/// One event, applied at the start of the next step.
struct InputEvent {
  enum class Kind { grab, move, release };

  Kind kind = Kind::grab;
  int handle = 0;              ///< chosen by the sender, unique while held
  Index face = 0;              ///< grab: global cloth face hit (cloths' faces in scene order)
  Vec3d barycentric{1, 0, 0};  ///< grab: weights of the face's vertices at the hit
  Vec3d target;                ///< grab, move: where the hit point is pulled to [m]
  double radius = 0;           ///< grab: patch radius in rest space [m]; 0: the parameter
  double stiffness = 0;        ///< grab: of the whole patch [N/m]; 0: the parameter
};

/// A held handle as shown to the user.
struct HandleState {
  int handle = 0;
  Vec3d hit;              ///< where the grabbed point is now [m]
  Vec3d target;           ///< where it is pulled to [m]
  double saturation = 0;  ///< pull / largest allowed pull, 0…1
};

/// Everything that is needed to run the same steps again.
struct Recording {
  struct Step {
    std::vector<InputEvent> events;
    std::vector<std::pair<std::string, double>> parameters;  ///< values changed before the step
  };

  std::string scene;  ///< built-in name or path
  std::string build = "cpu32";
  std::vector<std::string> overrides;  ///< --set arguments, "KEY=VALUE"
  std::vector<Step> steps;
  std::uint64_t final_hash = 0;
};

/// JSON, one line a step. Throws InputError naming file and element.
Recording load_recording(const std::string& path);
/// Written to a temporary beside `path` first, then renamed.
void save_recording(const Recording& recording, const std::string& path);

/// Turns a scene's scripted grabs into events, step by step.
class ScriptedInput {
 public:
  explicit ScriptedInput(const Scene& scene);
  /// Events for the step that starts at `time` and lasts `dt`. Handles are numbered from 1000.
  std::vector<InputEvent> events(double time, double dt);

 private:
  const Scene* scene_;
  std::vector<bool> held_;
  std::vector<bool> done_;
};

}  // namespace icloth
