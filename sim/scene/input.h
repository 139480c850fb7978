// Events by which hands act on the cloth. The mouse, a scene and a recording send the same ones.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
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

/// Handles of a scene's scripted grabs are numbered from here on; a user's lie between 1 and this.
inline constexpr int kFirstScriptedHandle = 1000;

/// A point of the cloth that is held, from its grab to its release.
struct HeldHandle {
  int id = 0;
  Index face = 0;              ///< global cloth face that was hit
  Vec3d barycentric{1, 0, 0};  ///< weights of the face's vertices at the hit
  Vec3d target;                ///< where the hit point is pulled to [m]
  double radius = 0;           ///< of the patch, in rest space [m]; 0: the parameter
  double stiffness = 0;        ///< of the whole patch [N/m]; 0: the parameter
};

inline HeldHandle handle_of(const InputEvent& grab) {
  return {grab.handle, grab.face, grab.barycentric, grab.target, grab.radius, grab.stiffness};
}

inline InputEvent event_of(InputEvent::Kind kind, const HeldHandle& handle) {
  return {kind,          handle.id,     handle.face,     handle.barycentric,
          handle.target, handle.radius, handle.stiffness};
}

/// Applies an event to a list of what is held. `take(event)` makes the entry of a grab; a handle
/// that is held already is let go first. Moves of handles that are not held are ignored.
template <class Held, class Take>
void apply_event(std::vector<Held>& held, const InputEvent& event, const Take& take) {
  const auto old = std::find_if(held.begin(), held.end(),
                                [&event](const Held& h) { return h.id == event.handle; });
  if (event.kind == InputEvent::Kind::move) {
    if (old != held.end()) old->target = event.target;
    return;
  }
  if (old != held.end()) held.erase(old);
  if (event.kind == InputEvent::Kind::grab) held.push_back(take(event));
}

/// A held handle as shown to the user.
struct HandleState : HeldHandle {
  Vec3d hit;              ///< where the grabbed point is now [m]
  double saturation = 0;  ///< pull / largest allowed pull, 0…1
};

/// Everything that is needed to run the same steps again.
struct Recording {
  struct Step {
    std::vector<InputEvent> events;
    std::vector<std::pair<std::string, double>> parameters;  ///< values changed before the step
    bool passed_over = false;  ///< it was refused, and the clock went on
  };

  std::string scene;  ///< built-in name or path
  std::string build = "cpu32";
  std::vector<std::string> overrides;  ///< --set arguments, "KEY=VALUE"
  std::vector<Step> steps;
  std::uint64_t final_hash = 0;
};

/// JSON, one line a step. Throws InputError naming file and element.
Recording load_recording(const std::string& path);
/// The same from a text; `name` stands for the file in messages.
Recording parse_recording(std::string_view text, const std::string& name);
/// Throws InputError naming step and event of the first grab of a face that the scene's cloths do
/// not have, as in a recording of another scene.
void check_recording(const Recording& recording, const Scene& scene, const std::string& path);
/// The text of a recording's file.
std::string recording_text(const Recording& recording);
/// Writes a temporary file beside `path` and renames it.
void save_recording(const Recording& recording, const std::string& path);

/// Turns a scene's scripted grabs into events, step by step.
class ScriptedInput {
 public:
  explicit ScriptedInput(const Scene& scene);
  /// Events for the step that starts at `time` and lasts `dt`.
  std::vector<InputEvent> events(double time, double dt);
  /// Says that a handle is held already, as after going back to an older state. Handles of others
  /// are ignored.
  void go_on_holding(int handle);

 private:
  const Scene* scene_;
  std::vector<bool> held_;
  std::vector<bool> done_;
};

}  // namespace icloth
