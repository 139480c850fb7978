#include "sim/files/polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>

#include "kernels/index.h"
#include "sim/files/box.h"
#include "sim/files/corner_tree.h"
#include "sim/files/grid_point.h"
#include "sim/files/ring_crossings.h"

namespace icloth {
namespace {

constexpr std::size_t kMostFanCorners = 32;  // a larger fan would crowd its first corner
constexpr double kFlattest = 1e-10;          // of the area against the square of the extent
constexpr double kThinnest = 1e-6;  // of twice a triangle's area against its longest edge²
// Boxes of corners that may be compared with triangles, altogether and for each corner: sensible
// polygons need less than a quarter of them.
constexpr std::int64_t kMostTests = 1'000'000, kMostTestsOfCorner = 4000;
constexpr double kGridCells = 1 << 29;  // along the extent: products of differences fit 64 bits

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
  const Vec3d size = box_around(corners).size();
  return std::max({size.x, size.y, size.z});
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

enum class Outcome { done, stuck, too_long };

using Ring = std::vector<Index>;
using Area = __int128;

/// Twice the area of the triangle from the origin.
Area from_origin(GridPoint a, GridPoint b) { return Area{a.x} * b.y - Area{a.y} * b.x; }

/// Splits a ring of points where it comes back to a place, if both parts turn left: a polygon that
/// touches itself at a corner becomes several. `drop_spikes`: a corner between two that are at one
/// place is left out.
std::vector<Ring> split_where_touching(const std::vector<GridPoint>& x, bool drop_spikes = false) {
  std::vector<Ring> rings;
  Area rest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) rest += from_origin(x[i], x[(i + 1) % x.size()]);

  // The corners so far that belong to no finished ring, the area that their path sweeps, and where
  // among them a place was met last.
  Ring path;
  std::vector<Area> swept;
  std::map<GridPoint, std::size_t> met;
  for (Index i = 0; i < static_cast<Index>(x.size()); ++i) {
    const GridPoint p = x[at(i)];
    if (const auto found = met.find(p); found != met.end()) {
      const std::size_t begin = found->second;
      const Area area = swept.back() - swept[begin] + from_origin(x[at(path.back())], p);
      const bool is_polygon = area > 0 && rest - area > 0;
      const bool is_spike = drop_spikes && path.size() - begin == 2;
      if (is_polygon || is_spike) {
        if (is_polygon)
          rings.emplace_back(path.begin() + static_cast<std::ptrdiff_t>(begin), path.end());
        rest -= area;
        for (std::size_t k = begin; k < path.size(); ++k) {
          const auto old = met.find(x[at(path[k])]);
          if (old != met.end() && old->second >= begin) met.erase(old);
        }
        path.resize(begin);
        swept.resize(begin);
      }
    }
    swept.push_back(path.empty() ? 0 : swept.back() + from_origin(x[at(path.back())], p));
    met[p] = path.size();
    path.push_back(i);
  }
  rings.push_back(std::move(path));
  return rings;
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
    tests_left_ = kMostTests + kMostTestsOfCorner * n;
    update_all();
  }

  /// Appends the triangles, unless no corner can be cut off any more or the search for one takes
  /// too long.
  Outcome cut(std::vector<Triangle>& triangles) {
    while (left_ > 3) {
      if (tests_left_ < 0) return Outcome::too_long;
      Index ear = best_ear();
      if (ear == kNone && careful_) {
        // Only thin triangles are left, or such that leave thin ones.
        careful_ = false;
        update_all();
        ear = best_ear();
      }
      if (ear == kNone) return Outcome::stuck;
      triangles.push_back(triangle_of(ear));
      cut_off(ear);
    }

    // The corners that remain have to turn as the polygon does.
    const Triangle last = triangle_of(first_);
    triangles.push_back(last);
    const bool turns_left = turn(x_[at(last[0])], x_[at(last[1])], x_[at(last[2])]) > 0;
    return turns_left ? Outcome::done : Outcome::stuck;
  }

 private:
  struct Corner {
    Index before, after;
    bool straight = false;  ///< or nearly so, or turns right: others must mind it
    bool gone = false;
    double shape = 0;  ///< of its triangle, 0: it cannot be cut off
    Index load = 0;    ///< triangles that end here so far
    Index crowd = 0;   ///< of the ends of its triangle, see crowd_of
  };

  /// An ear, in the order in which they are cut off.
  using Ear = std::tuple<Index, double, Index>;
  Ear ear(Index i) const { return {corners_[at(i)].crowd, -corners_[at(i)].shape, i}; }

  /// How many triangles the ends of a corner's triangle have already, in coarse steps: the best
  /// shaped ears of a round border would otherwise all end at one corner.
  Index crowd_of(Index i) const {
    const Corner& corner = corners_[at(i)];
    return std::max(corners_[at(corner.before)].load, corners_[at(corner.after)].load) / 8;
  }

  /// Puts an ear at its new place in the order after an end of its triangle has got another one.
  void move_ear(Index i) {
    if (ears_.erase(ear(i)) == 0) return;
    corners_[at(i)].crowd = crowd_of(i);
    ears_.insert(ear(i));
  }

  Triangle triangle_of(Index i) const { return {corners_[at(i)].before, i, corners_[at(i)].after}; }

  /// Whether a corner lies in a triangle or on its border. A corner just beyond the new edge, from
  /// the last point to the first, would be left with an angle of nearly 180°.
  bool holds(const Triangle& t, Index i) const {
    const GridPoint a = x_[at(t[0])], b = x_[at(t[1])], c = x_[at(t[2])], p = x_[at(i)];
    if (i == t[0] || i == t[1] || i == t[2] || p == a || p == b || p == c) return false;
    if (turn(a, b, p) < 0 || turn(b, c, p) < 0) return false;
    return static_cast<double>(turn(c, a, p)) >= -beyond(t);
  }

  double beyond(const Triangle& t) const {
    return careful_ ? kThinnest * length2(x_[at(t[2])], x_[at(t[0])]) : 0;
  }

  double least_shape() const { return careful_ ? kThinnest : 0; }

  void update(Index i) {
    Corner& corner = corners_[at(i)];
    ears_.erase(ear(i));
    const Triangle t = triangle_of(i);
    const GridPoint a = x_[at(t[0])], b = x_[at(t[1])], c = x_[at(t[2])];
    const double shape = thickness(a, b, c);
    corner.straight = shape <= least_shape();
    corner.shape = 0;
    straight_.set(i, corner.straight);
    if (corner.straight) return;

    // A triangle that holds another corner is no ear.
    const bool taken = straight_.any({a, b, c}, beyond(t), tests_left_,
                                     [&](Index other) { return holds(t, other); });
    if (taken) return;
    corner.shape = shape;
    corner.crowd = crowd_of(i);
    ears_.insert(ear(i));
  }

  void update_all() {
    // Whether a triangle is empty is asked of the straight corners, so they are found first.
    std::vector<Index> straight;
    const auto n = static_cast<Index>(corners_.size());
    for (Index i = 0; i < n; ++i) {
      const Triangle t = triangle_of(i);
      Corner& corner = corners_[at(i)];
      corner.straight = thickness(x_[at(t[0])], x_[at(t[1])], x_[at(t[2])]) <= least_shape();
      if (!corner.gone && corner.straight) straight.push_back(i);
    }
    straight_ = CornerTree(x_, straight);
    for (Index i = 0; i < n; ++i)
      if (!corners_[at(i)].gone) update(i);
  }

  /// The first of the best shaped ones among those whose ends are least crowded.
  Index best_ear() const { return ears_.empty() ? kNone : std::get<2>(*ears_.begin()); }

  /// Takes a corner out of the ring; what its neighbours can do changes, and nothing else.
  void cut_off(Index i) {
    const auto [before, after] = std::pair(corners_[at(i)].before, corners_[at(i)].after);
    ears_.erase(ear(i));
    straight_.set(i, false);
    corners_[at(i)].gone = true;
    corners_[at(before)].after = after;
    corners_[at(after)].before = before;
    if (first_ == i) first_ = after;
    --left_;
    ++corners_[at(before)].load;
    ++corners_[at(after)].load;
    update(before);
    update(after);
    move_ear(corners_[at(before)].before);
    move_ear(corners_[at(after)].after);
  }

  const std::vector<GridPoint>& x_;
  std::vector<Corner> corners_;
  CornerTree straight_;          ///< corners that were straight or turned right at the start
  std::set<Ear> ears_;           ///< corners that can be cut off
  std::int64_t tests_left_ = 0;  ///< of boxes against triangles
  Index first_ = 0, left_ = 0;
  bool careful_ = true;  ///< no thin triangles, and none that leave thin ones
};

/// Whether a place is inside of a ring: a ray to the right crosses it an odd number of times.
bool holds_place(const std::vector<GridPoint>& x, const Ring& ring, double px, double py) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const GridPoint a = x[at(ring[i])], b = x[at(ring[(i + 1) % ring.size()])];
    const auto ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
    const auto bx = static_cast<double>(b.x), by = static_cast<double>(b.y);
    if ((ay > py) != (by > py) && px < ax + (py - ay) * (bx - ax) / (by - ay)) inside = !inside;
  }
  return inside;
}

/// Whether a triangle of one ring lies in another ring. As edges do not cross, the ring does then.
bool lies_in_another(const std::vector<GridPoint>& x, const Triangle& t,
                     const std::vector<Ring>& rings, const Ring& own) {
  double px = 0, py = 0;
  for (const Index i : t) {
    px += static_cast<double>(x[at(i)].x) / 3;
    py += static_cast<double>(x[at(i)].y) / 3;
  }
  return std::ranges::any_of(
      rings, [&](const Ring& ring) { return &ring != &own && holds_place(x, ring, px, py); });
}

/// Cuts one ring after the other; appends nothing where that fails or rings lie in each other, as
/// those of a border that goes round twice.
Outcome cut_rings(const std::vector<GridPoint>& x, const std::vector<Ring>& rings,
                  std::vector<Triangle>& triangles) {
  constexpr std::size_t kMostRings = 64;  // each is compared with all others
  std::vector<GridPoint> points;
  std::vector<Triangle> all, found;
  if (rings.size() > kMostRings) return Outcome::too_long;
  for (const Ring& ring : rings) {
    points.clear();
    found.clear();
    for (const Index i : ring) points.push_back(x[at(i)]);
    const Outcome outcome = points.size() < 3 ? Outcome::stuck : EarClipper(points).cut(found);
    if (outcome != Outcome::done) return outcome;

    // The cut gives numbers of the ring's corners.
    const std::size_t first = all.size();
    for (const Triangle& t : found) all.push_back({ring[at(t[0])], ring[at(t[1])], ring[at(t[2])]});
    if (rings.size() > 1 && lies_in_another(x, all[first], rings, ring)) return Outcome::stuck;
  }
  triangles.insert(triangles.end(), all.begin(), all.end());
  return Outcome::done;
}

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
  if (corners.size() <= kMostFanCorners && is_fan(points)) {
    for (Index i = 2; i < n; ++i) triangles.push_back({0, i - 1, i});
    return "";
  }
  if (!crosses_itself(points)) {
    Outcome outcome = cut_rings(points, split_where_touching(points), triangles);
    if (outcome == Outcome::stuck)
      outcome = cut_rings(points, split_where_touching(points, true), triangles);
    if (outcome == Outcome::done) return "";
    if (outcome == Outcome::too_long) return "a polygon that is cut in less time";
  }
  return "a polygon that does not cross itself";
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
