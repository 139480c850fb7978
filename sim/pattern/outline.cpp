#include "sim/pattern/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace icloth {
namespace {

constexpr int kParts = 64;  ///< of a Bézier curve, each measured by itself

/// Gauss–Legendre rule of five points on [−1, 1], exact for polynomials of degree 9.
constexpr std::array<double, 5> kNodes{-0.9061798459386640, -0.5384693101056831, 0,
                                       0.5384693101056831, 0.9061798459386640};
constexpr std::array<double, 5> kWeights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};

template <class F>
double integrate(double from, double to, const F& f) {
  const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
  double sum = 0;
  for (std::size_t k = 0; k < kNodes.size(); ++k) sum += kWeights[k] * f(middle + half * kNodes[k]);
  return half * sum;
}

double cross_of(Vec2d a, Vec2d b) { return a.x * b.y - a.y * b.x; }
double norm_of(Vec2d a) { return std::sqrt(a.x * a.x + a.y * a.y); }
Vec2d corner(const Panel& panel, Index i) { return panel.corners[static_cast<std::size_t>(i)]; }

}  // namespace

GridPoint to_grid(Vec2d point) {
  return {std::llround(point.x / kPanelGrid), std::llround(point.y / kPanelGrid)};
}

Vec2d from_grid(GridPoint point) {
  return {static_cast<double>(point.x) * kPanelGrid, static_cast<double>(point.y) * kPanelGrid};
}

EdgePath::EdgePath(const Panel& panel, const PanelEdge& edge)
    : curve_(edge.curve), start_(corner(panel, edge.start)), end_(corner(panel, edge.end)) {
  // Straight lines and arcs have their length in closed form.
  if (curve_ == EdgeCurve::straight) {
    length_ = norm_of(end_ - start_);
    return;
  }
  if (curve_ == EdgeCurve::circle) {
    set_circle(edge.radius, edge.large_arc, edge.counter_clockwise);
    return;
  }

  if (curve_ == EdgeCurve::polyline) {
    set_polyline(edge.points);
    return;
  }

  // The power form of Bézier curves is quick to evaluate and to differentiate.
  const auto [p, q] = edge.control;
  if (curve_ == EdgeCurve::quadratic)
    bezier_ = {start_, 2.0 * (p - start_), start_ - 2.0 * p + end_, Vec2d{}};
  else
    bezier_ = {start_, 3.0 * (p - start_), 3.0 * (start_ - 2.0 * p + q),
               end_ - 3.0 * q + 3.0 * p - start_};

  // The length up to each part makes it quick to find the place of a share of the length.
  lengths_.assign(1, 0.0);
  for (int k = 0; k < kParts; ++k)
    lengths_.push_back(lengths_.back() +
                       arc_length(static_cast<double>(k) / kParts, (k + 1.0) / kParts));
  length_ = lengths_.back();
}

void EdgePath::set_polyline(std::span<const Vec2d> points) {
  polyline_.assign(1, start_);
  polyline_.insert(polyline_.end(), points.begin(), points.end());
  polyline_.push_back(end_);
  lengths_.assign(1, 0.0);
  for (std::size_t i = 1; i < polyline_.size(); ++i)
    lengths_.push_back(lengths_.back() + norm_of(polyline_[i] - polyline_[i - 1]));
  length_ = lengths_.back();
}

Vec2d EdgePath::at_of_polyline(double wanted) const {
  const auto above = std::ranges::upper_bound(lengths_, wanted) - lengths_.begin();
  const auto last = std::ssize(polyline_) - 2;
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, last));
  const double length = lengths_[i + 1] - lengths_[i];
  const double t = length > 0 ? (wanted - lengths_[i]) / length : 0;
  return polyline_[i] + t * (polyline_[i + 1] - polyline_[i]);
}

void EdgePath::set_circle(double radius, bool large, bool counter_clockwise) {
  // The centre lies on the bisector of the chord: to the left of the edge for a small arc that
  // turns counter-clockwise, and for a large one that turns clockwise.
  const Vec2d chord = end_ - start_;
  const double width = norm_of(chord);
  radius_ = std::max(radius, width / 2);
  const double height = std::sqrt(std::max(0.0, radius_ * radius_ - width * width / 4));
  const double side = (large != counter_clockwise ? height : -height) / std::max(width, 1e-300);
  centre_ = 0.5 * (start_ + end_) + side * Vec2d{-chord.y, chord.x};

  // The turn has the sign of its direction.
  const Vec2d from = start_ - centre_, to = end_ - centre_;
  angle_ = std::atan2(from.y, from.x);
  turn_ = std::atan2(to.y, to.x) - angle_;
  if (counter_clockwise && turn_ < 0) turn_ += 2 * std::numbers::pi;
  if (!counter_clockwise && turn_ > 0) turn_ -= 2 * std::numbers::pi;
  length_ = radius_ * std::fabs(turn_);
}

Vec2d EdgePath::point(double u) const {
  const auto& c = bezier_;
  return c[0] + u * (c[1] + u * (c[2] + u * c[3]));
}

double EdgePath::speed(double u) const {
  const auto& c = bezier_;
  return norm_of(c[1] + u * (2.0 * c[2] + (3 * u) * c[3]));
}

double EdgePath::arc_length(double from, double to) const {
  return integrate(from, to, [this](double u) { return speed(u); });
}

Vec2d EdgePath::at(double share) const {
  // Corners are met exactly, since two edges share each.
  if (share <= 0) return start_;
  if (share >= 1) return end_;
  if (curve_ == EdgeCurve::straight) return start_ + share * (end_ - start_);
  if (curve_ == EdgeCurve::polyline) return at_of_polyline(share * length_);
  if (curve_ == EdgeCurve::circle) {
    const double angle = angle_ + share * turn_;
    return centre_ + radius_ * Vec2d{std::cos(angle), std::sin(angle)};
  }

  // The part of the Bézier curve in which the wanted length lies is halved until it is a point.
  const double wanted = share * length_;
  const auto above = std::ranges::upper_bound(lengths_, wanted) - lengths_.begin();
  const auto part = std::clamp<std::ptrdiff_t>(above - 1, 0, kParts - 1);
  const double begin = static_cast<double>(part) / kParts;
  const double rest = wanted - lengths_[static_cast<std::size_t>(part)];
  double low = begin, high = begin + 1.0 / kParts;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (arc_length(begin, middle) < rest ? low : high) = middle;
  }
  return point(0.5 * (low + high));
}

double EdgePath::swept_area() const {
  if (curve_ == EdgeCurve::straight) return 0.5 * cross_of(start_, end_);
  if (curve_ == EdgeCurve::polyline) {
    double sum = 0;
    for (std::size_t i = 1; i < polyline_.size(); ++i)
      sum += 0.5 * cross_of(polyline_[i - 1], polyline_[i]);
    return sum;
  }

  // An arc sweeps the triangle below its chord and the segment beyond it.
  if (curve_ == EdgeCurve::circle)
    return 0.5 * cross_of(start_, end_) + 0.5 * radius_ * radius_ * (turn_ - std::sin(turn_));
  return integrate(0, 1, [this](double u) {
    const auto& c = bezier_;
    const Vec2d tangent = c[1] + u * (2.0 * c[2] + (3 * u) * c[3]);
    return 0.5 * cross_of(point(u), tangent);
  });
}

double signed_area(const Panel& panel) {
  double sum = 0;
  for (const PanelEdge& edge : panel.edges) sum += EdgePath(panel, edge).swept_area();
  return sum;
}

double perimeter(const Panel& panel) {
  double sum = 0;
  for (const PanelEdge& edge : panel.edges) sum += EdgePath(panel, edge).length();
  return sum;
}

std::vector<Vec2d> outline_polygon(const Panel& panel, int segments) {
  std::vector<Vec2d> points;
  for (const PanelEdge& edge : panel.edges) {
    const EdgePath path(panel, edge);
    const int count = edge.curve == EdgeCurve::straight ? 1 : segments;
    if (edge.curve == EdgeCurve::polyline) {
      points.push_back(corner(panel, edge.start));
      points.insert(points.end(), edge.points.begin(), edge.points.end());
      continue;
    }
    for (int k = 0; k < count; ++k) points.push_back(path.at(static_cast<double>(k) / count));
  }
  return points;
}

}  // namespace icloth
