#include "sim/pattern/panel_fill.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace icloth {
namespace {

constexpr double kClearance = 0.62;  ///< between the lattice and the outline [spacings]

struct Point {
  double x, y;
};

struct Interval {
  double low = 1e300, high = -1e300;

  void include(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// What the outline does to one row of the lattice.
struct Row {
  std::vector<double> crossings;  ///< where the row enters and leaves the ring
  std::vector<Interval> near;     ///< parts of the row that are too near to an edge
};

/// Where the level line at `y` crosses the line from a to b, which lie on both sides of it.
double crossing(Point a, Point b, double y) { return a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y); }

/// The part of the level line at `y` that is nearer than `distance` to the line from a to b: empty,
/// or an interval, since the points near a line make a convex set.
Interval near_part(Point a, Point b, double y, double distance) {
  Interval part;

  // The discs around both ends.
  for (const Point end : {a, b}) {
    const double dy = y - end.y, rest = distance * distance - dy * dy;
    if (rest <= 0) continue;
    const double half = std::sqrt(rest);
    part.include(end.x - half);
    part.include(end.x + half);
  }

  // The rectangle between them.
  const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
  if (!(length > 0)) return part;
  const double nx = -(b.y - a.y) / length * distance, ny = (b.x - a.x) / length * distance;
  const std::array<Point, 4> corners{Point{a.x + nx, a.y + ny}, Point{b.x + nx, b.y + ny},
                                     Point{b.x - nx, b.y - ny}, Point{a.x - nx, a.y - ny}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Point p = corners[k], q = corners[(k + 1) % 4];
    if ((p.y > y) != (q.y > y)) part.include(crossing(p, q, y));
  }
  return part;
}

/// The rows of the lattice over a ring.
class Lattice {
 public:
  Lattice(std::span<const GridPoint> ring, double spacing)
      : spacing_(spacing), rise_(spacing * std::numbers::sqrt3 / 2) {
    Interval x, y;
    for (const GridPoint& p : ring) {
      x.include(static_cast<double>(p.x));
      y.include(static_cast<double>(p.y));
    }
    middle_ = 0.5 * (x.low + x.high);

    // As many rows as fit, as far from the lower end as from the upper one.
    const double count = std::max(1.0, std::floor((y.high - y.low) / rise_));
    first_ = 0.5 * (y.low + y.high) - 0.5 * (count - 1) * rise_;
    rows_.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < ring.size(); ++i) add_edge(ring[i], ring[(i + 1) % ring.size()]);
  }

  std::vector<GridPoint> points() {
    std::vector<GridPoint> result;
    for (std::size_t r = 0; r < rows_.size(); ++r) add_points(r, result);
    return result;
  }

 private:
  double height(std::ptrdiff_t row) const { return first_ + static_cast<double>(row) * rise_; }

  /// Tells the rows that an edge crosses or comes near to.
  void add_edge(GridPoint from, GridPoint to) {
    const Point a{static_cast<double>(from.x), static_cast<double>(from.y)};
    const Point b{static_cast<double>(to.x), static_cast<double>(to.y)};
    const double distance = kClearance * spacing_;
    const auto [low, high] = std::minmax(a.y, b.y);
    const auto last = static_cast<double>(rows_.size()) - 1;
    const double begin = std::clamp(std::floor((low - distance - first_) / rise_), 0.0, last);
    const double end = std::clamp(std::ceil((high + distance - first_) / rise_), 0.0, last);

    for (auto r = static_cast<std::ptrdiff_t>(begin); r <= static_cast<std::ptrdiff_t>(end); ++r) {
      const double y = height(r);
      Row& row = rows_[static_cast<std::size_t>(r)];
      if ((a.y > y) != (b.y > y)) row.crossings.push_back(crossing(a, b, y));
      const Interval near = near_part(a, b, y, distance);
      if (near.low <= near.high) row.near.push_back(near);
    }
  }

  /// Walks along a row, from one crossing to the next, past what is too near.
  void add_points(std::size_t r, std::vector<GridPoint>& points) {
    Row& row = rows_[r];
    std::ranges::sort(row.crossings);
    std::ranges::sort(row.near, {}, &Interval::low);
    const double shift = r % 2 == 1 ? 0.5 : 0;
    const auto place = [&](double k) { return middle_ + (k + shift) * spacing_; };

    auto near = row.near.begin();
    double covered = -1e300;  // right end of all intervals that begin before the point
    for (std::size_t i = 0; i + 1 < row.crossings.size(); i += 2) {
      double k = std::ceil((row.crossings[i] - middle_) / spacing_ - shift);
      for (; place(k) < row.crossings[i + 1]; ++k) {
        const double x = place(k);
        for (; near != row.near.end() && near->low <= x; ++near)
          covered = std::max(covered, near->high);
        if (x > covered)
          points.push_back({std::llround(x), std::llround(height(static_cast<std::ptrdiff_t>(r)))});
      }
    }
  }

  double spacing_, rise_;
  double middle_ = 0, first_ = 0;  ///< x of the middle, y of the lowest row
  std::vector<Row> rows_;
};

}  // namespace

std::vector<GridPoint> fill_outline(std::span<const GridPoint> ring, double spacing) {
  if (ring.empty()) return {};
  return Lattice(ring, spacing).points();
}

}  // namespace icloth
