#include "sim/scene/material_space.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"
#include "sim/files/disjoint_sets.h"
#include "sim/files/text.h"
#include "sim/scene/half_edges.h"

namespace icloth {
namespace {

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
  DisjointSets sets(mesh.faces.size());
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh.faces);
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j) {
        const HalfEdge& a = sides[i];
        const HalfEdge& b = sides[j];
        const bool same_way =
            mesh.faces[at(a.face)][at(a.corner)] == mesh.faces[at(b.face)][at(b.corner)];
        if (joined_in_material(mesh.uv[at(a.face)], at(a.corner), mesh.uv[at(b.face)], at(b.corner),
                               same_way))
          sets.unite(at(a.face), at(b.face));
      }
  }

  // The smallest face of a set comes first, so a panel has its number before its other faces ask.
  std::vector<Index> panel(mesh.faces.size());
  Index count = 0;
  for (std::size_t f = 0; f < panel.size(); ++f) {
    const std::size_t first = sets.find(f);
    panel[f] = first == f ? count++ : panel[first];
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
