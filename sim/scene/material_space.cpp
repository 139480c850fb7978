#include "sim/scene/material_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/index.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// A side of a face: corner `corner` to the next one.
struct Side {
  std::array<Index, 2> edge;  // smaller vertex first
  Index face, corner;
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& faces) {
  std::vector<Side> sides;
  sides.reserve(3 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (Index c = 0; c < 3; ++c) {
      const Index a = faces[f][at(c)], b = faces[f][at((c + 1) % 3)];
      sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<Index>(f), c});
    }
  std::ranges::sort(sides, [](const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.face < b.face;
  });
  return sides;
}

/// Sets of faces that are joined pair by pair; the smallest face stands for its set.
class FaceSets {
 public:
  explicit FaceSets(std::size_t faces) : parent_(faces) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index find(Index f) {
    while (parent_[at(f)] != f) f = parent_[at(f)] = parent_[at(parent_[at(f)])];
    return f;
  }
  void join(Index a, Index b) {
    a = find(a);
    b = find(b);
    parent_[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

double real_area(const std::vector<Vec3d>& x, const Triangle& t) {
  return 0.5 * norm(cross(x[at(t[1])] - x[at(t[0])], x[at(t[2])] - x[at(t[0])]));
}

std::string triangle(std::size_t f) { return "triangle " + std::to_string(f); }

}  // namespace

bool joined_in_material(const std::array<Vec2d, 3>& first, std::size_t i,
                        const std::array<Vec2d, 3>& second, std::size_t j, bool same_way) {
  const Vec2d edge = first[(i + 1) % 3] - first[i];
  const Vec2d start = second[same_way ? j : (j + 1) % 3] - first[i];
  const Vec2d end = second[same_way ? (j + 1) % 3 : j] - first[(i + 1) % 3];
  const double gap = std::hypot(start.x, start.y) + std::hypot(end.x, end.y);
  return gap <= 1e-3 * std::hypot(edge.x, edge.y);
}

double doubled_material_area(const std::array<Vec2d, 3>& corners) {
  const Vec2d a = corners[1] - corners[0], b = corners[2] - corners[0];
  return a.x * b.y - a.y * b.x;
}

std::vector<Index> find_panels(const TriangleMesh& mesh) {
  // Faces are joined wherever they share an edge that is no seam.
  FaceSets sets(mesh.faces.size());
  const std::vector<Side> sides = sorted_sides(mesh.faces);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j) {
        const Side& a = sides[i];
        const Side& b = sides[j];
        const bool same_way =
            mesh.faces[at(a.face)][at(a.corner)] == mesh.faces[at(b.face)][at(b.corner)];
        if (joined_in_material(mesh.uv[at(a.face)], at(a.corner), mesh.uv[at(b.face)], at(b.corner),
                               same_way))
          sets.join(a.face, b.face);
      }
  }

  // The smallest face of a set comes first, so a panel has its number before its other faces ask.
  std::vector<Index> panel(mesh.faces.size());
  Index count = 0;
  for (std::size_t f = 0; f < panel.size(); ++f) {
    const Index first = sets.find(static_cast<Index>(f));
    panel[f] = at(first) == f ? count++ : panel[at(first)];
  }
  return panel;
}

void turn_mirrored_panels(TriangleMesh& mesh) {
  const std::vector<Index> panel = find_panels(mesh);
  if (panel.empty()) return;

  std::vector<double> area(at(std::ranges::max(panel)) + 1);
  for (std::size_t f = 0; f < panel.size(); ++f)
    area[at(panel[f])] += doubled_material_area(mesh.uv[f]);

  for (std::size_t f = 0; f < panel.size(); ++f)
    if (area[at(panel[f])] < 0)
      for (Vec2d& corner : mesh.uv[f]) corner.x = -corner.x;
}

std::string rest_shape_problem(const TriangleMesh& mesh) {
  constexpr double kSmallestArea = 1e-12;  // [m²]
  constexpr double kFlat = 1e-9;           // area over the square of the longest side
  for (std::size_t f = 0; f < mesh.uv.size(); ++f) {
    const std::array<Vec2d, 3>& u = mesh.uv[f];
    const double area = 0.5 * doubled_material_area(u);
    if (!std::isfinite(area)) return triangle(f) + " has a coordinate that is not finite";

    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec2d side = u[(c + 1) % 3] - u[c];
      longest = std::max(longest, side.x * side.x + side.y * side.y);
    }
    if (std::fabs(area) < kSmallestArea || std::fabs(area) < kFlat * longest)
      return triangle(f) + " has no area in them";
    if (area < 0) return triangle(f) + " is turned over against the panel around it";
  }
  return "";
}

double material_share(const TriangleMesh& mesh, const std::vector<Vec3d>& positions) {
  double flat = 0, real = 0;
  for (std::size_t f = 0; f < mesh.uv.size(); ++f) {
    flat += 0.5 * std::fabs(doubled_material_area(mesh.uv[f]));
    real += real_area(positions, mesh.faces[f]);
  }
  return flat / real;
}

std::string size_problem(const TriangleMesh& mesh, const std::vector<Vec3d>& rest) {
  // The whole is looked at first: coordinates of another unit are off in every triangle.
  const double share = material_share(mesh, rest);
  if (!(std::fabs(share - 1) < 0.1))
    return "their area is " + rounded_text(share) + " times that of the mesh";

  for (std::size_t f = 0; f < mesh.uv.size(); ++f) {
    const double area = 0.5 * doubled_material_area(mesh.uv[f]);
    const double own = real_area(rest, mesh.faces[f]);
    if (area < 0) return triangle(f) + " is turned over against the panel around it";
    if (area < 0.5 * own || area > 2 * own)
      return triangle(f) + " has " + rounded_text(area / own) + " times its area in them";
  }
  return "";
}

}  // namespace icloth
