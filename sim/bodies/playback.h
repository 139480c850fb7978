// When a body shows which moment of its clip or point cache.
#pragma once

namespace icloth {

/// A moment of what is played, and how far the body has come to it from its bind pose.
struct PlayedMoment {
  double time = 0;   ///< of the clip [s]
  double blend = 1;  ///< 0: bind pose, 1: the clip
};

/// How a clip or a point cache is played. The scene starts in the bind pose where there is a blend:
/// a garment that was draped over the bind pose fits there, and what happens before time 0, like
/// dressing, sees the body at rest in the pose of time 0. The blend then takes the first seconds of
/// the scene, and the clip starts after it.
struct Playback {
  double start = 0;     ///< moment of the clip that is shown first [s]
  double speed = 1;     ///< seconds of the clip for each second of the scene, below 0 backwards
  bool loop = false;    ///< starts again at its end, else the body keeps the last pose
  double blend_in = 0;  ///< [s] of the scene from the bind pose to the moment `start`

  /// `time`: of the scene [s]; before 0 the body is where it is at 0. `duration`: of the clip [s].
  PlayedMoment at(double time, double duration) const;
  /// Whether a clip of that length changes anything over time.
  bool moves(double duration) const { return blend_in > 0 || (speed != 0 && duration > 0); }
};

}  // namespace icloth
