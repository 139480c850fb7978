// Panels in space.
#include <cmath>
#include <numbers>

#include "sim/pattern/sewing.h"

namespace icloth {
namespace {

struct Turn {
  double sine, cosine;
};

/// Sine and cosine of an angle in degrees; exact for right angles, so that panels that face
/// forwards, backwards or sideways have no rounding in their places.
Turn turn_by(double degrees) {
  const double quarter = std::nearbyint(degrees / 90);
  const double rest = (degrees - 90 * quarter) * (std::numbers::pi / 180);
  const double s = std::sin(rest), c = std::cos(rest);
  const double index = quarter - 4 * std::floor(quarter / 4);
  if (index == 1) return {c, -s};
  if (index == 2) return {-s, -c};
  if (index == 3) return {-c, s};
  return {s, c};
}

/// Rz Ry Rx.
Mat3<double> rotation_of(Vec3d degrees) {
  const auto [sx, cx] = turn_by(degrees.x);
  const auto [sy, cy] = turn_by(degrees.y);
  const auto [sz, cz] = turn_by(degrees.z);
  return {{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx,  //
           sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx,  //
           -sy, cy * sx, cy * cx}};
}

}  // namespace

std::vector<PanelPlacement> placements_of(const Pattern& pattern) {
  std::vector<PanelPlacement> placements;
  for (const Panel& panel : pattern.panels) placements.push_back(panel.placement);
  return placements;
}

std::vector<Vec3d> place_points(std::span<const Vec2d> points, const PanelPlacement& placement) {
  const Mat3<double> rotation = rotation_of(placement.rotation);
  const double r = placement.bend_radius;
  std::vector<Vec3d> placed;
  placed.reserve(points.size());
  for (const Vec2d& p : points) {
    const Vec3d x = r == 0 ? Vec3d{p.x, p.y, 0}
                           : Vec3d{r * std::sin(p.x / r), p.y, r * (std::cos(p.x / r) - 1)};
    placed.push_back(rotation * x + placement.translation);
  }
  return placed;
}

}  // namespace icloth
