#include "sim/scene/repair_seams.h"

#include <algorithm>
#include <cmath>

#include "kernels/distance.h"
#include "kernels/index.h"

namespace icloth {
namespace {

/// Surfaces behind two borders look into different directions from this length of the difference
/// of the directions on (about 14°); closer ones are layers of each other.
constexpr double kBeside = 0.25;

/// An edge of a border, and where the surface behind it lies.
struct BorderEdge {
  Index a, b;
  Vec3d along;   ///< unit
  Vec3d inward;  ///< unit, in the plane of the face, across the edge
};

bool is_border(const RepairMesh& mesh, Index edge) { return mesh.edge_faces[edge].size() == 1; }

/// Edges of the border at the faces of a contour and at the faces around those.
std::vector<BorderEdge> border_near(const RepairMesh& mesh, const Contour& contour) {
  std::vector<Index> edges;
  for (const Contour::Segment& s : contour.segments)
    for (const Index v : mesh.faces[at(s.own)])
      for (const Index f : mesh.vertex_faces[v])
        for (const Index e : mesh.face_edges[at(f)])
          if (is_border(mesh, e)) edges.push_back(e);
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  // Across an edge is what a side of the face leaves over of its direction along the edge.
  std::vector<BorderEdge> border;
  for (const Index e : edges) {
    const auto [a, b] = mesh.edges[at(e)];
    const Vec3d along = normalized(mesh.position(b) - mesh.position(a));
    Vec3d middle;
    for (const Vec3d& corner : mesh.corners(mesh.edge_faces[e].front()))
      middle += corner - mesh.position(a);
    const Vec3d inward = normalized(middle - dot(middle, along) * along);
    if (norm2(along) > 0 && norm2(inward) > 0) border.push_back({a, b, along, inward});
  }
  return border;
}

/// Vertex v of one border against edge e of the other, seen in the plane of `along` and `n`.
void add_vertex(const RepairMesh& mesh, Index v, const BorderEdge& e, Vec3d along, Vec3d n,
                double sign, double offset, std::vector<GapConstraint>& constraints) {
  if (v == e.a || v == e.b) return;
  const Vec3d side = mesh.position(e.b) - mesh.position(e.a);
  const Vec3d gap = mesh.position(v) - mesh.position(e.a);
  const double length = dot(side, along);
  if (length == 0) return;
  const double s = dot(gap, along) / length;
  const double reach = 0.5 * norm(side);
  if (!(s >= 0 && s <= 1 && norm2(gap - s * side) < reach * reach)) return;
  constraints.push_back({{v, e.a, e.b, e.b}, {1, s - 1, -s, 0}, sign * n, offset});
}

bool touches_border(const RepairMesh& mesh, Index face) {
  for (const Index v : mesh.faces[at(face)])
    for (const Index f : mesh.vertex_faces[v])
      for (const Index e : mesh.face_edges[at(f)]) {
        const auto [a, b] = mesh.edges[at(e)];
        if ((a == v || b == v) && is_border(mesh, e)) return true;
      }
  return false;
}

bool runs_along_border(const RepairMesh& mesh, const Contour& contour) {
  return std::ranges::all_of(
      contour.segments, [&](const Contour::Segment& s) { return touches_border(mesh, s.own); });
}

}  // namespace

std::vector<GapConstraint> keep_beside(const RepairMesh& mesh, const Contour& own,
                                       const Contour& twin, double offset) {
  const std::vector<BorderEdge> lower = border_near(mesh, twin);
  std::vector<GapConstraint> constraints;
  for (const BorderEdge& e : border_near(mesh, own))
    for (const BorderEdge& f : lower) {
      // Borders that run across each other have no line in common.
      const double cosine = dot(e.along, f.along);
      if (std::fabs(cosine) < 0.5) continue;
      const Vec3d along = normalized(e.along + (cosine < 0 ? -1.0 : 1.0) * f.along);
      Vec3d apart = e.inward - f.inward;
      apart = apart - dot(apart, along) * along;
      if (norm(apart) < kBeside) continue;
      const Vec3d n = normalized(apart);

      for (const Index v : {e.a, e.b}) add_vertex(mesh, v, f, along, n, 1, offset, constraints);
      for (const Index v : {f.a, f.b}) add_vertex(mesh, v, e, along, n, -1, offset, constraints);
    }
  return constraints;
}

void choose_seams(const RepairMesh& mesh, std::span<const Contour> contours, double limit,
                  std::vector<Side>& sides) {
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const std::size_t twin = contours[c].twin;
    if (twin <= c || !runs_along_border(mesh, contours[c]) ||
        !runs_along_border(mesh, contours[twin]))
      continue;

    // How far the borders reach over each other.
    double shift = 0;
    const auto constraints = keep_beside(mesh, contours[c], contours[twin], 0);
    for (const GapConstraint& g : constraints) shift = std::max(shift, -gap_of(mesh, g));
    if (constraints.empty() || shift > limit) continue;
    for (const std::size_t view : {c, twin}) sides[view] = {0, shift, true, {}, {}};
  }
}

}  // namespace icloth
