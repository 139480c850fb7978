#include "sim/bodies/cached_poses.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace icloth {

CachedPoses::CachedPoses(std::vector<std::vector<Vec3f>> frames, double frame_rate,
                         Playback playback, std::vector<Vec3d> mesh)
    : frames_(std::move(frames)),
      frame_rate_(frame_rate),
      playback_(playback),
      mesh_(std::move(mesh)) {}

double CachedPoses::duration() const {
  return static_cast<double>(frames_.size() - 1) / frame_rate_;
}

void CachedPoses::pose(double time, std::vector<Vec3d>& out) const {
  // The moment lies between two frames, or at one of the ends.
  const PlayedMoment moment = playback_.at(time, duration());
  const double last = static_cast<double>(frames_.size() - 1);
  const double frame = std::clamp(moment.time * frame_rate_, 0.0, last);
  const auto first = static_cast<std::size_t>(frame);
  const double fraction = frame - std::floor(frame);
  const std::vector<Vec3f>&a = frames_[first],
        &b = frames_[std::min(first + 1, frames_.size() - 1)];
  out.resize(a.size());
  for (std::size_t v = 0; v < a.size(); ++v)
    out[v] = (1 - fraction) * convert<double>(a[v]) + fraction * convert<double>(b[v]);

  // A body that is blended in comes from its mesh.
  if (moment.blend == 1) return;
  for (std::size_t v = 0; v < out.size(); ++v)
    out[v] = (1 - moment.blend) * mesh_[v] + moment.blend * out[v];
}

}  // namespace icloth
