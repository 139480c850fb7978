#include "sim/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "sim/scene/transforms.h"

namespace icloth {
namespace {

/// Interval of sorted samples that holds `time`, and how far into it; clamped at both ends.
struct Interval {
  std::size_t first, second;
  double fraction;
};

Interval find_interval(const std::vector<Keyframe>& keys, double time) {
  const auto after = std::ranges::upper_bound(keys, time, {}, &Keyframe::time);
  if (after == keys.begin()) return {0, 0, 0};
  const auto second = static_cast<std::size_t>(after - keys.begin());
  if (second == keys.size()) return {second - 1, second - 1, 0};
  const double start = keys[second - 1].time, end = keys[second].time;
  return {second - 1, second, (time - start) / (end - start)};
}

Interval find_frame(std::size_t count, double frame) {
  const double last = static_cast<double>(count - 1);
  const double clamped = std::clamp(frame, 0.0, last);
  const auto first = static_cast<std::size_t>(clamped);
  return {first, std::min(first + 1, count - 1), clamped - std::floor(clamped)};
}

}  // namespace

void Obstacle::pose(double time, std::vector<Vec3d>& out) const {
  // An animation gives the positions between two of its frames, on straight lines.
  if (frames.empty()) {
    out = mesh.positions;
  } else {
    const Interval at = find_frame(frames.size(), time * frame_rate);
    const std::vector<Vec3f>&a = frames[at.first], &b = frames[at.second];
    out.resize(a.size());
    for (std::size_t v = 0; v < a.size(); ++v)
      out[v] = (1 - at.fraction) * convert<double>(a[v]) + at.fraction * convert<double>(b[v]);
  }

  // Keyframes then move the whole body rigidly. Rotation vectors are interpolated component by
  // component, so turns beyond 360 degrees are kept.
  if (motion.empty()) return;
  const Interval at = find_interval(motion, time);
  const Keyframe &a = motion[at.first], &b = motion[at.second];
  const double s = at.fraction;
  const Eigen::Matrix3d rotation =
      angle_axis((1 - s) * a.rotation + s * b.rotation).toRotationMatrix();
  const Vec3d translation = (1 - s) * a.translation + s * b.translation;
  for (Vec3d& p : out) p = from_eigen(rotation * to_eigen(p)) + translation;
}

}  // namespace icloth
