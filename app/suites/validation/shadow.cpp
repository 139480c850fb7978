#include "app/suites/validation/shadow.h"

#include <algorithm>
#include <cmath>

namespace icloth::validation {
namespace {

/// Twice the signed area of a triangle: the side of the line a b on which p lies.
double side(Vec2d a, Vec2d b, Vec2d p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

}  // namespace

Shadow::Shadow(Vec2d low, Vec2d high, double cell)
    : low_(low),
      cell_(cell),
      columns_(static_cast<int>(std::lround((high.x - low.x) / cell))),
      rows_(static_cast<int>(std::lround((high.y - low.y) / cell))),
      covered_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void Shadow::add(const std::vector<Vec3d>& positions, const std::vector<Triangle>& faces) {
  const auto place = [&](Index v) {
    const Vec3d p = positions[static_cast<std::size_t>(v)];
    return Vec2d{p.x, p.z};
  };
  for (const Triangle& f : faces) add(place(f[0]), place(f[1]), place(f[2]));
}

void Shadow::add(Vec2d a, Vec2d b, Vec2d c) {
  // Only the squares about the triangle have to be tested.
  const auto cell_of = [&](double value, double low, int count) {
    return static_cast<int>(std::clamp((value - low) / cell_, 0.0, count - 1.0));
  };
  const int first_i = cell_of(std::min({a.x, b.x, c.x}), low_.x, columns_);
  const int last_i = cell_of(std::max({a.x, b.x, c.x}), low_.x, columns_);
  const int first_j = cell_of(std::min({a.y, b.y, c.y}), low_.y, rows_);
  const int last_j = cell_of(std::max({a.y, b.y, c.y}), low_.y, rows_);

  // A square is covered when its middle is inside, for either orientation.
  for (int j = first_j; j <= last_j; ++j)
    for (int i = first_i; i <= last_i; ++i) {
      const Vec2d p = middle(i, j);
      const double u = side(a, b, p), v = side(b, c, p), w = side(c, a, p);
      if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) at(i, j) = 1;
    }
}

void Shadow::add_disc(Vec2d centre, double radius) {
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const Vec2d p = middle(i, j);
      if (std::hypot(p.x - centre.x, p.y - centre.y) < radius) at(i, j) = 1;
    }
}

double Shadow::area() const {
  return cell_ * cell_ * static_cast<double>(std::ranges::count(covered_, 1));
}

}  // namespace icloth::validation
