#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace icloth {

namespace {

using Colour = std::array<float, 4>;

constexpr Colour kMark{0.85f, 0.03f, 0.02f, 1};
constexpr Colour kPin{0.02f, 0.16f, 0.55f, 1};
constexpr Colour kHover{1, 1, 1, 0.9f};
constexpr Colour kRim{0.01f, 0.01f, 0.015f, 0.85f};
constexpr Colour kDrop{0.02f, 0.02f, 0.03f, 0.8f};
constexpr int kRound = 20;  // corners of a disc

/// The colour of a pull: from easy green over yellow to red, where the pull is as large as it may
/// be.
Colour saturation_colour(double saturation) {
  const auto s = static_cast<float>(std::clamp(saturation, 0., 1.));
  return {std::min(1.f, 0.06f + 1.6f * s), std::min(0.6f, 1.2f * (1 - s)), 0.05f, 1};
}

/// Collects triangles that face the camera, with sizes in pixels.
class Builder {
 public:
  Builder(const Camera& camera, int height)
      : camera_(camera), eye_(camera.eye()), height_(height) {}

  void triangle(Vec3d a, Vec3d b, Vec3d c, const Colour& colour) {
    vertex(a, colour);
    vertex(b, colour);
    vertex(c, colour);
  }

  /// Adds a quad that faces the eye, `width` pixels wide at both ends.
  void line(Vec3d a, Vec3d b, double width, const Colour& colour) {
    const Vec3d across = normalized(cross(b - a, 0.5 * (a + b) - eye_));
    const Vec3d at_a = (0.5 * width * pixel(a)) * across, at_b = (0.5 * width * pixel(b)) * across;
    triangle(a - at_a, a + at_a, b + at_b, colour);
    triangle(a - at_a, b + at_b, b - at_b, colour);
  }

  /// Adds a ball as a disc that is lighter at the centre, with a dark rim.
  void ball(Vec3d centre, double radius, const Colour& colour) {
    const Vec3d front = lifted(centre, 1.5 * radius);
    ring(lifted(centre, 1.4 * radius), radius, radius + 1.2, kRim);
    Colour light = colour;
    for (std::size_t k = 0; k < 3; ++k) light[k] = 0.6f * light[k] + 0.4f;
    const double r = radius * pixel(front);
    for (int k = 0; k < kRound; ++k) {
      vertex(front, light);
      vertex(front + r * around(k), colour);
      vertex(front + r * around(k + 1), colour);
    }
  }

  void ring(Vec3d centre, double inner, double outer, const Colour& colour) {
    const double a = inner * pixel(centre), b = outer * pixel(centre);
    for (int k = 0; k < kRound; ++k) {
      const Vec3d u = around(k), v = around(k + 1);
      triangle(centre + a * u, centre + b * u, centre + b * v, colour);
      triangle(centre + a * u, centre + b * v, centre + a * v, colour);
    }
  }

  /// Adds a level disc, like a shadow.
  void level_disc(Vec3d centre, double radius, const Colour& colour) {
    const double r = radius * pixel(centre);
    const auto at = [&](int k) {
      const double angle = 2 * std::numbers::pi * k / kRound;
      return centre + Vec3d{r * std::cos(angle), 0, r * std::sin(angle)};
    };
    for (int k = 0; k < kRound; ++k) triangle(centre, at(k), at(k + 1), colour);
  }

  /// Moves a point towards the eye by so many pixels, so that a flat shape is not cut by the cloth.
  Vec3d lifted(Vec3d p, double pixels) const {
    return p + (pixels * pixel(p)) * normalized(eye_ - p);
  }

  std::vector<OverlayVertex> take() { return std::move(vertices_); }

 private:
  void vertex(Vec3d p, const Colour& c) {
    vertices_.push_back({convert<float>(p), {c[0], c[1], c[2], c[3]}});
  }
  double pixel(Vec3d p) const {
    return camera_.pixel_size(std::max(1e-6, dot(p - eye_, camera_.forward())), height_);
  }
  Vec3d around(int k) const {
    const double angle = 2 * std::numbers::pi * k / kRound;
    return std::cos(angle) * camera_.right() + std::sin(angle) * camera_.up();
  }

  const Camera& camera_;
  Vec3d eye_;
  int height_;
  std::vector<OverlayVertex> vertices_;
};

Vec3d at(const Frame& frame, Index vertex) {
  return convert<double>(frame.positions[static_cast<std::size_t>(vertex)]);
}

}  // namespace

std::vector<OverlayVertex> overlay_triangles(const World& world, const Frame& frame,
                                             const Camera& camera, int height) {
  Builder builder(camera, height);

  // Offending faces are filled and outlined, since a face that is seen edge-on must still be found.
  for (Index f : frame.marked_faces) {
    const Triangle& t = world.face[static_cast<std::size_t>(f)];
    const Vec3d a = builder.lifted(at(frame, t[0]), 1), b = builder.lifted(at(frame, t[1]), 1),
                c = builder.lifted(at(frame, t[2]), 1);
    builder.triangle(a, b, c, kMark);
    builder.line(a, b, 2, kMark);
    builder.line(b, c, 2, kMark);
    builder.line(c, a, 2, kMark);
  }

  // Pins are balls, those of the scene small.
  for (Index v : frame.marked_vertices) builder.ball(at(frame, v), 3, kPin);
  for (const Vec3d& pin : frame.pins) {
    builder.ball(pin, 5, kPin);
    builder.ring(builder.lifted(pin, 8), 5, 7, kHover);
  }

  // Lines along the cloth are light, with a dark one below them for light cloth.
  for (const LineSegment& line : frame.outlines) {
    builder.line(builder.lifted(line.a, 2), builder.lifted(line.b, 2), 3, kRim);
    builder.line(builder.lifted(line.a, 3), builder.lifted(line.b, 3), 1.5, kHover);
  }

  // Every handle is a line from the cloth to its target, coloured by how hard it pulls.
  for (const HandleState& handle : frame.handles) {
    const Colour colour = saturation_colour(handle.saturation);
    builder.line(builder.lifted(handle.hit, 4), builder.lifted(handle.target, 4), 2.5, colour);
    builder.ball(handle.hit, 4, colour);
    builder.ball(handle.target, 6, colour);
  }

  // A dashed plumb line ends in a spot on what it meets.
  constexpr int kDashes = 12;
  for (const DropLine& drop : frame.drop_lines) {
    const Vec3d dash = (1.0 / (2 * kDashes)) * (drop.to - drop.from);
    for (int k = 0; k < kDashes; ++k)
      builder.line(drop.from + (2. * k) * dash, drop.from + (2. * k + 1) * dash, 2, kDrop);
    builder.level_disc(builder.lifted(drop.to, 2), 9, kDrop);
  }

  // A stitch is a line between its two points until they meet: red far apart, green near each
  // other.
  constexpr double kShut = 5e-4, kWide = 0.05;  // [m]
  for (const auto& [a, b] : frame.stitches) {
    const Vec3d from = at(frame, a), to = at(frame, b);
    const double gap = norm(to - from);
    if (gap > kShut)
      builder.line(builder.lifted(from, 3), builder.lifted(to, 3), 1.5,
                   saturation_colour(gap / kWide));
  }

  // The patch under the pointer is shown as rings.
  for (const Vec3f point : frame.hover) {
    const Vec3d p = builder.lifted(convert<double>(point), 8);
    builder.ring(p, 6, 8, kHover);
    builder.ring(p, 8, 9.2, kRim);
  }
  return builder.take();
}

}  // namespace icloth
