#include "render/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/view_matrices.h"
#include "sim/files/box.h"

namespace icloth {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr Vec3d kKey{-0.85, 0.95, 0.55};
constexpr double kKeyRadius = 0.09;  // of the disc, seen from the cloth [rad]

double fraction(double x) { return x - std::floor(x); }

/// Two unit vectors across a direction.
void axes(Vec3d direction, Vec3d& right, Vec3d& up) {
  const Vec3d helper = std::fabs(direction.y) < 0.99 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  right = normalized(cross(helper, direction));
  up = cross(direction, right);
}

/// The sphere around a box.
Bounds sphere_around(const Box& box) {
  if (box.empty()) return {};
  return {0.5 * (box.low + box.high), std::max(1e-3, 0.5 * norm(box.size())), box.low.y};
}

}  // namespace

Bounds bounds_of(std::span<const Vec3f> points, std::size_t cloth) {
  constexpr double kNear = 4;  // in radii of the cloth

  // The cloth decides which of the other points are near enough to matter.
  Box box;
  for (const Vec3f p : points.first(cloth)) box.add(convert<double>(p));
  const Bounds near_cloth = sphere_around(box);
  const double reach = kNear * near_cloth.radius;
  for (const Vec3f point : points.subspan(cloth)) {
    const Vec3d p = convert<double>(point), offset = p - near_cloth.centre;
    if (cloth == 0 || norm2(offset) < reach * reach) box.add(p);
  }
  return sphere_around(box);
}

LightSample light_sample(int i, int n) {
  LightSample sample{};
  sample.key = normalized(kKey);
  sample.dome = {0, 1, 0};
  if (n <= 1) return sample;

  // The offsets in the pixel are those of a square grid.
  const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(n))));
  sample.pixel_x = (i % side + 0.5) / side - 0.5;
  sample.pixel_y = (i / side % side + 0.5) / side - 0.5;

  // The disc is sampled by an additive recurrence (Roberts 2018, the plastic number), mapped by
  // equal areas.
  const double u = fraction(0.5 + 0.7548776662466927 * i),
               v = fraction(0.5 + 0.5698402909980532 * i);
  const double r = kKeyRadius * std::sqrt(u);
  Vec3d right, up;
  axes(sample.key, right, up);
  sample.key =
      normalized(sample.key + r * std::cos(2 * kPi * v) * right + r * std::sin(2 * kPi * v) * up);

  // The dome is sampled by a Fibonacci lattice; the heights are spread evenly, and so is the area.
  const double height = (i + 0.5) / n;
  const double around = 2 * kPi * fraction(i * std::numbers::phi);
  const double out = std::sqrt(1 - height * height);
  sample.dome = {out * std::cos(around), height, out * std::sin(around)};
  return sample;
}

Eigen::Matrix4d light_matrix(const Bounds& bounds, Vec3d direction) {
  Vec3d right, up;
  axes(direction, right, up);
  const Vec3d eye = bounds.centre + bounds.radius * direction;

  // Parallel rays: x and y go from −half to half, and the depth from the eye to the far side.
  const double half = 1.02 * bounds.radius;
  const Eigen::Affine3d orthographic =
      Eigen::Translation3d(0, 0, -1) * Eigen::Scaling(1 / half, 1 / half, -1 / bounds.radius);
  return (orthographic * look(eye, right, up, direction)).matrix();
}

}  // namespace icloth
