// The hands of a user between two looks at the mouse: the window draws less often than the solver
// steps, and a hand that jumped from place to place would shake the cloth.
#pragma once

#include <vector>

#include "sim/scene/input.h"

namespace icloth {

/// Collects the events of hands as they come, and gives each step its own. A place that a hand is
/// moved to is reached over the time that had passed since the last one, on a straight line; so
/// hands move alike at any pace of the window, and lag behind by one look at the mouse. Times are
/// those of the simulation [s], so that what a step gets depends on nothing else.
class HandPaths {
 public:
  /// An event that came before the step that starts at `time`.
  void post(const InputEvent& event, double time);
  /// What the step that starts at `time` and lasts `dt` is to be given.
  std::vector<InputEvent> events(double time, double dt);
  /// Applies what has not been given to a step yet: places on the way count as reached.
  void apply_to(std::vector<HandleState>& handles) const;
  /// Forgets all of it, as after a jump in time.
  void clear();

 private:
  struct Path {
    int handle = 0;
    Vec3d at, goal;      ///< where the last step was told to pull, and where the hand is [m]
    double seen = 0;     ///< when the hand was looked at last [s]
    double span = 0;     ///< time from the look before to that one [s]
    double arrival = 0;  ///< when the goal is to be reached [s]
  };

  Path* find(int handle);
  void post_move(const InputEvent& event, double time);

  std::vector<InputEvent> queue_;  ///< grabs and releases, in the order in which they came
  std::vector<Path> paths_;        ///< of held hands, in the order in which they grabbed
  double pace_ = 0;                ///< the last time between two looks at a moving hand [s]
};

}  // namespace icloth
