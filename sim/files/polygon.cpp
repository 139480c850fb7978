#include "sim/files/polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace icloth {
namespace {

constexpr double kFlattest = 1e-10;     // of the area against the square of the extent
constexpr double kThinnest = 1e-6;      // of twice a triangle's area against its longest edge²
constexpr double kGridCells = 1 << 29;  // along the extent: products of differences fit 64 bits

/// Place on a grid in the plane of the polygon: what turns left or right is decided exactly.
struct GridPoint {
  std::int64_t x, y;
  bool operator==(const GridPoint&) const = default;
};

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Twice the signed area of a triangle.
std::int64_t turn(GridPoint a, GridPoint b, GridPoint c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double length2(GridPoint a, GridPoint b) {
  const auto x = static_cast<double>(b.x - a.x), y = static_cast<double>(b.y - a.y);
  return x * x + y * y;
}

/// Twice the area against the square of the longest edge; negative where it turns right.
double thickness(GridPoint a, GridPoint b, GridPoint c) {
  const double longest = std::max({length2(a, b), length2(b, c), length2(c, a)});
  return longest > 0 ? static_cast<double>(turn(a, b, c)) / longest : 0;
}

/// Twice the area vector of a polygon, which is its Newell normal.
Vec3d area_vector(std::span<const Vec3d> corners) {
  Vec3d sum{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  return sum;
}

double largest_extent(std::span<const Vec3d> corners) {
  Vec3d low = corners[0], high = low;
  for (const Vec3d p : corners) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

/// The corners seen along the normal, where the polygon turns left.
std::vector<GridPoint> project(std::span<const Vec3d> corners, Vec3d normal, double extent) {
  const Vec3d a{std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  const Vec3d axis = a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0}
                     : a.y <= a.z             ? Vec3d{0, 1, 0}
                                              : Vec3d{0, 0, 1};
  const Vec3d u = normalized(cross(axis, normal)), v = cross(normal, u);

  // In the plane, the extent is at most √3 times the largest one along an axis, to either side.
  const double cells = kGridCells / (4 * extent);
  std::vector<GridPoint> points;
  points.reserve(corners.size());
  for (const Vec3d p : corners)
    points.push_back({std::llround(cells * dot(p - corners[0], u)),
                      std::llround(cells * dot(p - corners[0], v))});
  return points;
}

/// True where the triangles between the first corner and all other edges cover the polygon once
/// and none of them is thin: that is the cut which keeps the order of the corners.
bool is_fan(const std::vector<GridPoint>& x) {
  for (std::size_t i = 2; i < x.size(); ++i)
    if (turn(x[0], x[1], x[i]) <= 0 || thickness(x[0], x[i - 1], x[i]) < kThinnest) return false;
  return true;
}

bool cross_each_other(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  const auto sign = [](std::int64_t value) { return (value > 0) - (value < 0); };
  return sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 &&
         sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0;
}

/// Whether two edges cross; only edges whose ranges of x overlap are compared.
bool crosses_itself(const std::vector<GridPoint>& x) {
  const std::size_t n = x.size();
  const auto left = [&](std::size_t i) { return std::min(x[i].x, x[(i + 1) % n].x); };
  const auto right = [&](std::size_t i) { return std::max(x[i].x, x[(i + 1) % n].x); };

  // In the order of their left ends, the edges that can cross an edge stand right behind it.
  std::vector<std::size_t> edges(n);
  std::iota(edges.begin(), edges.end(), std::size_t{0});
  std::ranges::sort(edges, {}, [&](std::size_t i) { return std::pair(left(i), i); });
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t l = k + 1; l < n && left(edges[l]) <= right(edges[k]); ++l) {
      const std::size_t i = edges[k], j = edges[l];
      if (cross_each_other(x[i], x[(i + 1) % n], x[j], x[(j + 1) % n])) return true;
    }
  return false;
}

/// Cuts off one corner after the other whose triangle holds no other corner, the best shaped one
/// first.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<GridPoint>& points) : x_(points) {
    const auto n = static_cast<Index>(points.size());
    corners_.resize(points.size());
    for (Index i = 0; i < n; ++i) corners_[at(i)] = {(i + n - 1) % n, (i + 1) % n};
    left_ = n;
    update_all();
  }

  /// Appends the triangles; false where no corner can be cut off any more.
  bool cut(std::vector<Triangle>& triangles) {
    while (left_ > 3) {
      Index ear = best_ear();
      if (ear == kNone && careful_) {
        // Only thin triangles are left, or such that leave thin ones.
        careful_ = false;
        update_all();
        ear = best_ear();
      }
      if (ear == kNone) return false;
      triangles.push_back(triangle_of(ear));
      cut_off(ear);
    }

    // The corners that remain have to turn as the polygon does.
    const Triangle last = triangle_of(first_);
    triangles.push_back(last);
    return turn(x_[at(last[0])], x_[at(last[1])], x_[at(last[2])]) > 0;
  }

 private:
  struct Corner {
    Index before, after;
    bool straight = false;  ///< or nearly so, or turns right: others must mind it
    bool gone = false;
    double shape = 0;  ///< of its triangle, 0: it cannot be cut off
  };

  Triangle triangle_of(Index i) const { return {corners_[at(i)].before, i, corners_[at(i)].after}; }

  /// Whether a corner lies in a triangle or on its border. A corner just beyond the new edge, from
  /// the last point to the first, would be left with an angle of nearly 180°.
  bool holds(const Triangle& t, Index i) const {
    const GridPoint a = x_[at(t[0])], b = x_[at(t[1])], c = x_[at(t[2])], p = x_[at(i)];
    if (i == t[0] || i == t[1] || i == t[2] || p == a || p == b || p == c) return false;
    if (turn(a, b, p) < 0 || turn(b, c, p) < 0) return false;
    const double beyond = careful_ ? kThinnest * length2(c, a) : 0;
    return static_cast<double>(turn(c, a, p)) >= -beyond;
  }

  double least_shape() const { return careful_ ? kThinnest : 0; }

  void update(Index i) {
    Corner& corner = corners_[at(i)];
    const Triangle t = triangle_of(i);
    const GridPoint a = x_[at(t[0])], b = x_[at(t[1])], c = x_[at(t[2])];
    const double shape = thickness(a, b, c);
    corner.straight = shape <= least_shape();
    corner.shape = 0;
    if (corner.straight) return;

    // A triangle that holds another corner is no ear.
    for (const Index other : straight_) {
      const Corner& o = corners_[at(other)];
      if (!o.gone && o.straight && holds(t, other)) return;
    }
    corner.shape = shape;
  }

  void update_all() {
    // Whether a triangle is empty is asked of the straight corners, so they are found first.
    straight_.clear();
    const auto n = static_cast<Index>(corners_.size());
    for (Index i = 0; i < n; ++i) {
      const Triangle t = triangle_of(i);
      Corner& corner = corners_[at(i)];
      corner.straight = thickness(x_[at(t[0])], x_[at(t[1])], x_[at(t[2])]) <= least_shape();
      if (!corner.gone && corner.straight) straight_.push_back(i);
    }
    for (Index i = 0; i < n; ++i)
      if (!corners_[at(i)].gone) update(i);
  }

  Index best_ear() const {
    Index best = kNone, i = first_;
    for (Index k = 0; k < left_; ++k, i = corners_[at(i)].after) {
      const double shape = corners_[at(i)].shape;
      if (shape > (best == kNone ? 0 : corners_[at(best)].shape)) best = i;
    }
    return best;
  }

  /// Takes a corner out of the ring; what its neighbours can do changes, and nothing else.
  void cut_off(Index i) {
    const auto [before, after] = std::pair(corners_[at(i)].before, corners_[at(i)].after);
    corners_[at(i)].gone = true;
    corners_[at(before)].after = after;
    corners_[at(after)].before = before;
    if (first_ == i) first_ = after;
    --left_;
    update(before);
    update(after);
  }

  const std::vector<GridPoint>& x_;
  std::vector<Corner> corners_;
  std::vector<Index> straight_;  ///< corners that were straight or turned right at the start
  Index first_ = 0, left_ = 0;
  bool careful_ = true;  ///< no thin triangles, and none that leave thin ones
};

/// Numbers of the corners that are not at the place of the one before.
std::vector<Index> distinct_corners(std::span<const Vec3d> corners) {
  std::vector<Index> ring;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (ring.empty() || !(corners[i] == corners[at(ring.back())]))
      ring.push_back(static_cast<Index>(i));
  while (ring.size() > 1 && corners[at(ring.back())] == corners[at(ring.front())]) ring.pop_back();
  return ring;
}

std::string cut_ring(std::span<const Vec3d> corners, std::vector<Triangle>& triangles) {
  const auto n = static_cast<Index>(corners.size());
  const double extent = largest_extent(corners);
  const Vec3d normal = area_vector(corners);
  if (!(norm(normal) > kFlattest * extent * extent)) return "corners that span an area";

  // Most polygons are convex: their fan needs no further tests.
  const std::vector<GridPoint> points = project(corners, normalized(normal), extent);
  if (is_fan(points)) {
    for (Index i = 2; i < n; ++i) triangles.push_back({0, i - 1, i});
    return "";
  }
  if (crosses_itself(points) || !EarClipper(points).cut(triangles))
    return "a polygon that does not cross itself";
  return "";
}

}  // namespace

std::string cut_polygon(std::span<const Vec3d> corners, std::vector<Triangle>& triangles) {
  const std::string most = "at most " + std::to_string(kMostCorners) + " corners";
  if (corners.size() > kMostCorners) return most;

  // A triangle has nothing to cut; whether it has an area is tested with the mesh.
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return "";
  }

  // Work on the corners that lie apart, and give the triangles the numbers of the given ones.
  const std::vector<Index> ring = distinct_corners(corners);
  if (ring.size() < 3) return "corners that span an area";
  std::vector<Triangle> found;
  std::string expected;
  if (ring.size() == 3) {
    found.push_back({0, 1, 2});
  } else {
    std::vector<Vec3d> places;
    for (const Index i : ring) places.push_back(corners[at(i)]);
    expected = cut_ring(places, found);
  }

  if (!expected.empty()) return expected;
  for (const Triangle& t : found)
    triangles.push_back({ring[at(t[0])], ring[at(t[1])], ring[at(t[2])]});
  return "";
}

bool same_faces(const MeshFile& a, const MeshFile& b) {
  if (a.mesh.positions.size() != b.mesh.positions.size() || a.polygons != b.polygons ||
      a.mesh.faces.size() != b.mesh.faces.size())
    return false;

  // The triangles between the polygons are compared, those of the polygons need not be equal.
  std::size_t begin = 0;
  const auto equal_until = [&](std::size_t end) {
    return std::equal(a.mesh.faces.begin() + static_cast<std::ptrdiff_t>(begin),
                      a.mesh.faces.begin() + static_cast<std::ptrdiff_t>(end),
                      b.mesh.faces.begin() + static_cast<std::ptrdiff_t>(begin));
  };

  for (const FilePolygon& p : a.polygons) {
    if (!equal_until(at(p.first_face))) return false;
    begin = at(p.first_face + p.face_count);
  }
  return equal_until(a.mesh.faces.size());
}

void cut_like(const MeshFile& pattern, MeshFile& file) {
  for (const FilePolygon& polygon : file.polygons) {
    const std::size_t first = at(polygon.first_face), end = first + at(polygon.face_count);

    // Texture coordinates belong to corners, which are found by their vertices.
    std::vector<std::pair<Index, Vec2d>> uv;
    for (std::size_t f = first; f < end && !file.mesh.uv.empty(); ++f)
      for (std::size_t c = 0; c < 3; ++c)
        uv.emplace_back(file.mesh.faces[f][c], file.mesh.uv[f][c]);
    std::ranges::stable_sort(uv, {}, &std::pair<Index, Vec2d>::first);

    // Corners keep their texture coordinates, though the triangles around them change.
    for (std::size_t f = first; f < end; ++f) {
      file.mesh.faces[f] = pattern.mesh.faces[f];
      for (std::size_t c = 0; c < 3 && !uv.empty(); ++c) {
        const auto found = std::ranges::lower_bound(uv, file.mesh.faces[f][c], {},
                                                    &std::pair<Index, Vec2d>::first);
        if (found != uv.end()) file.mesh.uv[f][c] = found->second;
      }
    }
  }
}

}  // namespace icloth
