// The scenes of Tang et al. 2018, Fig. 8, and the named stretches of steps in which they are
// measured: where contact is heavy, or where the body moves fastest.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/scene.h"

namespace icloth {

/// A stretch begins before step `first` + 1. A garment cannot be run through all of its dance at
/// the paper's size, so its clip starts shortly before the stretch.
struct Stretch {
  long first = 0, steps = 20;
  std::string_view what;  ///< what happens there
  double clip_start = -1;  ///< moment at which the clip of the body starts [s]; −1: the scene's own

  long end() const { return first + steps; }
};

/// The steps as "100–140"; the moment at which the clip starts is not in it.
std::string steps_text(const Stretch& stretch);
/// The same with that moment: "80–100, clip from 3.55 s".
std::string stretch_text(const Stretch& stretch);

/// What the paper measured on a GTX 1080.
struct PublishedSpeed {
  double cama, pscc, icloth;                  ///< [steps/s]
  double pscc_collisions, icloth_collisions;  ///< collision handling [s] a step
};

struct PaperScene {
  std::string_view name, title;  ///< of the built-in scene, and in the paper
  int triangles;                 ///< the paper's
  int rate;                      ///< steps a simulated second, as in the paper
  PublishedSpeed published;
  std::vector<Stretch> stretches;
  double step_seconds;  ///< about the time of a step at that size, for the time left

  bool is_garment() const { return stretches.front().clip_start >= 0; }
};

/// In the order of the paper's table, with all their stretches.
const std::vector<PaperScene>& paper_scenes();

/// Below this share of the paper's triangles a report is a quick look.
inline constexpr double kQuickLook = 0.5;

/// The scenes with the stretches that a report of this scale has: a quick look leaves out what
/// takes long to reach, all but the first two stretches of a cloth and the first of a garment.
std::vector<PaperScene> scenes_at(double scale);

/// Seconds of a garment's run before its stretch: the scene's "blend_in", in which the body comes
/// from its bind pose, and then the clip itself until the cloth follows it.
inline constexpr double kBlendIn = 0.5, kFollowing = 0.3;

/// A moment of a clip at which a body is fast.
struct FastMoment {
  double begin = 0;  ///< [s] of the clip
  double speed = 0;  ///< mean of its vertices over the window [m/s]
};

/// The windows of a clip in which the vertices of the body are fastest on average, the fastest
/// first, and no two of them nearer to each other than half a second. Windows begin at multiples of
/// 0.05 s, and not so early that the clip would have to start before its beginning. `obstacle`
/// plays its clip from the beginning after `blend_in` [s].
std::vector<FastMoment> fastest_moments(const Obstacle& obstacle, double blend_in, double duration,
                                        double window, std::size_t count);

}  // namespace icloth
