#include "sim/scene/intersections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "kernels/index.h"
#include "kernels/parallel/parallel_for.h"

#if defined(ICLOTH_HAS_CGAL)
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#endif

namespace icloth {
namespace {

Box box_of(const FaceCorners& t) {
  Box box;
  for (Vec3d p : t) box.add(p);
  return box;
}

/// True when the segment p q certainly does not touch the triangle.
bool certainly_misses(Vec3d p, Vec3d q, const FaceCorners& t) {
  const int above = certain_side(t[0], t[1], t[2], p);
  if (above != 0 && above == certain_side(t[0], t[1], t[2], q)) return true;
  int signs = 0;  // bit 0: left of an edge seen along p q, bit 1: right of one
  for (std::size_t k = 0; k < 3; ++k) {
    const int side = certain_side(p, q, t[k], t[(k + 1) % 3]);
    if (side != 0) signs |= side > 0 ? 1 : 2;
  }
  return signs == 3;
}

/// Two triangles meet only where an edge of one meets the other.
bool certainly_disjoint(const FaceCorners& s, const FaceCorners& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!certainly_misses(s[k], s[(k + 1) % 3], t) || !certainly_misses(t[k], t[(k + 1) % 3], s))
      return false;
  return true;
}

using Point2 = std::array<double, 2>;

/// Sign of the turn a b c in a plane where it is certain in spite of rounding, else 0.
int certain_turn(Point2 a, Point2 b, Point2 c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double bound = 4.0 * 0x1p-53 * (std::fabs(left) + std::fabs(right)) + 1e-280;
  return left - right > bound ? 1 : left - right < -bound ? -1 : 0;
}

/// True when a line along an edge of s certainly has s on one side and t on the other.
bool certainly_separates(const std::array<Point2, 3>& s, const std::array<Point2, 3>& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Point2 a = s[k], b = s[(k + 1) % 3];
    const int own = certain_turn(a, b, s[(k + 2) % 3]);
    if (own != 0 &&
        std::ranges::all_of(t, [&](const Point2& p) { return certain_turn(a, b, p) == -own; }))
      return true;
  }
  return false;
}

/// True when the triangles are certainly apart as seen along one of the axes. In a flat cloth all
/// tests in space are in doubt.
bool certainly_look_apart(const FaceCorners& s, const FaceCorners& t) {
  const auto along = [](const FaceCorners& c, double Vec3d::*x, double Vec3d::*y) {
    return std::array{Point2{c[0].*x, c[0].*y}, Point2{c[1].*x, c[1].*y}, Point2{c[2].*x, c[2].*y}};
  };
  constexpr double Vec3d::*kAxes[] = {&Vec3d::x, &Vec3d::y, &Vec3d::z, &Vec3d::x};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = along(s, kAxes[k], kAxes[k + 1]), b = along(t, kAxes[k], kAxes[k + 1]);
    if (certainly_separates(a, b) || certainly_separates(b, a)) return true;
  }
  return false;
}

#if defined(ICLOTH_HAS_CGAL)
bool intersect(const FaceCorners& s, const FaceCorners& t) {
  if (certainly_disjoint(s, t) || certainly_look_apart(s, t)) return false;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto triangle = [](const FaceCorners& c) {
    const auto point = [](Vec3d p) { return Kernel::Point_3(p.x, p.y, p.z); };
    return Kernel::Triangle_3(point(c[0]), point(c[1]), point(c[2]));
  };
  const Kernel::Triangle_3 a = triangle(s), b = triangle(t);
  // A face without area has no plane; cloths with one are refused at load, bodies have some.
  if (a.is_degenerate() || b.is_degenerate()) return false;
  return CGAL::do_intersect(a, b);
}
#else
bool intersect(const FaceCorners& s, const FaceCorners& t) {
  return !certainly_disjoint(s, t) && !certainly_look_apart(s, t) && triangles_meet(s, t);
}
#endif

bool share_vertex(const Triangle& a, const Triangle& b) {
  for (Index v : a)
    if (v == b[0] || v == b[1] || v == b[2]) return true;
  return false;
}

std::vector<FaceCorners> corners_of(std::span<const Vec3d> positions,
                                    std::span<const Triangle> faces) {
  std::vector<FaceCorners> corners;
  for (const Triangle& t : faces)
    corners.push_back({positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]});
  return corners;
}

std::vector<Box> boxes_of(std::span<const FaceCorners> corners) {
  std::vector<Box> boxes;
  for (const FaceCorners& face : corners) boxes.push_back(box_of(face));
  return boxes;
}

/// Runs find(a, add) for all faces at once, which calls add(b) for those that a meets.
template <class Find>
std::vector<IntersectingFaces> collect_pairs(std::size_t faces, const Find& find) {
  std::vector<IntersectingFaces> found;
  std::mutex lock;  // the order of arrival is undone by the sort below
  parallel_for(static_cast<Index>(faces), 64, 64, [&](Index first, Index last) {
    for (Index a = first; a < last; ++a)
      find(a, [&](Index b) {
        const std::lock_guard guard(lock);
        found.push_back({std::min(a, b), std::max(a, b)});
      });
  });
  std::ranges::sort(found, [](const IntersectingFaces& s, const IntersectingFaces& t) {
    return s.a != t.a ? s.a < t.a : s.b < t.b;
  });
  return found;
}

}  // namespace

FaceTree::FaceTree(std::span<const Vec3d> positions, std::span<const Triangle> faces)
    : corners_(corners_of(positions, faces)), boxes_(boxes_of(corners_)), tree_(boxes_) {}

std::vector<IntersectingFaces> find_intersections(std::span<const Vec3d> positions,
                                                  std::span<const Triangle> faces,
                                                  std::span<const int> group) {
  const FaceTree tree(positions, faces);
  const auto is_obstacle = [&](Index f) { return !group.empty() && group[at(f)] < 0; };
  return collect_pairs(faces.size(), [&](Index a, const auto& add) {
    if (is_obstacle(a)) return;
    tree.visit(tree.box(a), [&](Index b) {
      if (b <= a && !is_obstacle(b)) return;  // found from the other side
      if (share_vertex(faces[at(a)], faces[at(b)])) return;
      if (intersect(tree.corners(a), tree.corners(b))) add(b);
    });
  });
}

std::vector<IntersectingFaces> find_intersections(std::span<const Vec3d> positions,
                                                  std::span<const Triangle> faces,
                                                  const FaceTree& fixed) {
  const FaceTree tree(positions, faces);
  const auto own = static_cast<Index>(faces.size());
  return collect_pairs(faces.size(), [&](Index a, const auto& add) {
    tree.visit(tree.box(a), [&](Index b) {
      if (b > a && !share_vertex(faces[at(a)], faces[at(b)]) &&
          intersect(tree.corners(a), tree.corners(b)))
        add(b);
    });
    fixed.visit(tree.box(a), [&](Index b) {
      if (intersect(tree.corners(a), fixed.corners(b))) add(own + b);
    });
  });
}

StartConflicts find_start_conflicts(const Scene& scene, bool single_precision) {
  // The objects become one soup of faces; `held` marks the vertices that cannot move.
  std::vector<Vec3d> positions;
  std::vector<Triangle> faces;
  std::vector<int> group;
  std::vector<std::uint8_t> held;
  const auto append = [&](const TriangleMesh& mesh, const std::vector<Vec3d>& pose, int number) {
    const auto first = static_cast<Index>(positions.size());
    positions.insert(positions.end(), pose.begin(), pose.end());
    for (const Triangle& t : mesh.faces)
      faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    group.resize(faces.size(), number);
    held.resize(positions.size(), static_cast<std::uint8_t>(number < 0));
  };

  // Cloths come first, then obstacles where they are at time 0.
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const std::size_t first = positions.size();
    append(scene.cloths[c].mesh, scene.cloths[c].mesh.positions, static_cast<int>(c));
    for (const Index pin : scene.cloths[c].pins) held[first + at(pin)] = 1;
  }
  std::vector<Vec3d> pose;
  for (const Obstacle& obstacle : scene.obstacles) {
    obstacle.pose(0.0, pose);
    append(obstacle.mesh, pose, -1);
  }

  // Rounding to single precision can bring layers together that are apart in the scene.
  if (single_precision)
    for (Vec3d& p : positions) p = convert<double>(convert<float>(p));

  // The collision test leaves out neighbours that are held altogether, since they never move.
  StartConflicts conflicts{find_intersections(positions, faces, group),
                           find_touching_neighbours(positions, faces, group)};
  std::erase_if(conflicts.touches, [&](const Touch& touch) {
    return std::ranges::all_of(touch.v, [&](Index v) { return v < 0 || held[at(v)] != 0; });
  });
  return conflicts;
}

std::vector<IntersectingFaces> face_pairs(const StartConflicts& conflicts) {
  std::vector<IntersectingFaces> pairs = conflicts.pairs;
  for (const Touch& touch : conflicts.touches) pairs.push_back({touch.a, touch.b});
  const auto key = [](const IntersectingFaces& p) { return std::pair(p.a, p.b); };
  const auto same = [&](const auto& p, const auto& q) { return key(p) == key(q); };
  std::ranges::sort(pairs, {}, key);
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  return pairs;
}

std::vector<IntersectingFaces> find_start_intersections(const Scene& scene, bool single_precision) {
  return face_pairs(find_start_conflicts(scene, single_precision));
}

}  // namespace icloth
