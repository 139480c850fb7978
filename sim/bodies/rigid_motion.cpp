#include "sim/bodies/rigid_motion.h"

#include <algorithm>

#include "sim/bodies/eigen.h"

namespace icloth {
namespace {

/// Interval of the keyframes that holds a time, and how far into it; clamped at both ends.
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

}  // namespace

Affine rigid_pose(const std::vector<Keyframe>& keys, double time) {
  // Rotation vectors are interpolated component by component, so turns beyond 360 degrees are kept.
  const Interval at = find_interval(keys, time);
  const Keyframe &a = keys[at.first], &b = keys[at.second];
  const double s = at.fraction;
  const Eigen::Matrix3d rotation =
      angle_axis((1 - s) * a.rotation + s * b.rotation).toRotationMatrix();
  return make_affine(rotation, to_eigen((1 - s) * a.translation + s * b.translation));
}

}  // namespace icloth
