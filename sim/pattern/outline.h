// The curves of panel edges: where they go, how long they are, and what they enclose.
#pragma once

#include <span>
#include <vector>

#include "sim/files/grid_point.h"
#include "sim/pattern/pattern.h"

namespace icloth {

/// Distance of the grid on which all points of a meshed panel lie [m]. It is a power of two, so
/// that grid points and lengths become each other without rounding.
inline constexpr double kPanelGrid = 1.0 / (1 << 23);

GridPoint to_grid(Vec2d point);
Vec2d from_grid(GridPoint point);

/// A panel edge by its arc length.
class EdgePath {
 public:
  EdgePath(const Panel& panel, const PanelEdge& edge);

  double length() const { return length_; }  ///< [m]
  /// The point at a share of the length, from 0 (the start) to 1 (the end).
  Vec2d at(double share) const;
  /// Signed area between the edge and the origin: ½ ∫ (x dy − y dx) [m²].
  double swept_area() const;

 private:
  Vec2d point(double u) const;
  double speed(double u) const;
  double arc_length(double from, double to) const;
  void set_polyline(std::span<const Vec2d> points);
  Vec2d at_of_polyline(double wanted) const;
  void set_circle(double radius, bool large, bool counter_clockwise);

  EdgeCurve curve_;
  std::array<Vec2d, 4> bezier_;  ///< in power form: Σ bezier_[k] u^k
  Vec2d start_, end_;
  Vec2d centre_;                              ///< of a circle
  double radius_ = 0, angle_ = 0, turn_ = 0;  ///< of a circle: at the start, and to the end
  std::vector<Vec2d> polyline_;               ///< corners included
  std::vector<double> lengths_;  ///< up to each of equal parts of u, or each point of a polyline
  double length_ = 0;
};

/// Area of a panel, above 0 where its loop turns counter-clockwise [m²].
double signed_area(const Panel& panel);
double perimeter(const Panel& panel);  ///< [m]

/// The loop as a polygon: each curved edge becomes `segments` straight ones, and polylines keep
/// their points.
std::vector<Vec2d> outline_polygon(const Panel& panel, int segments);

}  // namespace icloth
