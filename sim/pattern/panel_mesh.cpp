#include "sim/pattern/panel_mesh.h"

#include <algorithm>
#include <boost/polygon/voronoi.hpp>
#include <cmath>

#include "kernels/index.h"
#include "sim/pattern/panel_fill.h"

namespace icloth {
namespace {

constexpr int kRounds = 10;          ///< of smoothing
constexpr double kRelaxation = 0.9;  ///< share of the way to the better place

/// The directed edges of triangles: which triangle has the edge from a to b on its left.
class DirectedEdges {
 public:
  DirectedEdges(std::span<const Triangle> faces, std::size_t vertices) : first_(vertices + 1) {
    // A counting sort by the first vertex: count, sum up, write.
    for (const Triangle& t : faces)
      for (const Index v : t) ++first_[at(v) + 1];
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    entries_.resize(3 * faces.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        entries_[next[at(faces[f][k])]++] = {faces[f][(k + 1) % 3], static_cast<Index>(f)};
  }

  /// The first face with this edge, or kNone.
  Index face(Index from, Index to) const {
    for (std::size_t i = first_[at(from)]; i < first_[at(from) + 1]; ++i)
      if (entries_[i].to == to) return entries_[i].face;
    return kNone;
  }

 private:
  struct Entry {
    Index to, face;
  };
  std::vector<std::size_t> first_;
  std::vector<Entry> entries_;
};

/// Keeps the triangles of a ring's inside: those to the left of the ring's edges, and all that are
/// reached from them without crossing the ring. Returns the edges of the ring that no triangle has;
/// the triangles are then left as they are.
std::vector<Index> keep_inside(std::vector<Triangle>& faces, Index ring, std::size_t vertices) {
  const DirectedEdges edges(faces, vertices);
  const auto is_ring = [&](Index a, Index b) { return a < ring && b == (a + 1) % ring; };

  // The ring's edges must all be there. Their left sides are where the inside begins.
  std::vector<Index> missing, todo;
  std::vector<char> inside(faces.size(), 0);
  for (Index i = 0; i < ring; ++i) {
    const Index f = edges.face(i, (i + 1) % ring);
    if (f == kNone) missing.push_back(i);
    if (f == kNone || inside[at(f)]) continue;
    inside[at(f)] = 1;
    todo.push_back(f);
  }
  if (!missing.empty()) return missing;

  // From there the inside spreads over all edges that are not the ring's.
  while (!todo.empty()) {
    const Triangle t = faces[at(todo.back())];
    todo.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      const Index f = is_ring(a, b) ? kNone : edges.face(b, a);
      if (f == kNone || inside[at(f)]) continue;
      inside[at(f)] = 1;
      todo.push_back(f);
    }
  }

  std::size_t kept = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (inside[f]) faces[kept++] = faces[f];
  faces.resize(kept);
  return missing;
}

/// Whether the faces cover the inside of the ring exactly once and use every point. Areas on the
/// grid are whole numbers, so their sum tells without a tolerance.
bool covers_ring(std::span<const GridPoint> points, Index ring, std::span<const Triangle> faces) {
  std::vector<char> used(points.size(), 0);
  std::int64_t area = 0, wanted = 0;
  for (const Triangle& t : faces) {
    area += turn(points[at(t[0])], points[at(t[1])], points[at(t[2])]);
    for (const Index v : t) used[at(v)] = 1;
  }
  for (Index i = 1; i + 1 < ring; ++i) wanted += turn(points[0], points[at(i)], points[at(i) + 1]);
  return area == wanted && std::ranges::find(used, 0) == used.end();
}

/// Triangulates the inside. Returns false where the faces do not cover it; `mesh.missing` says then
/// whether edges of the ring are the reason.
bool triangulate(OutlineMesh& mesh, Index ring) {
  mesh.faces = delaunay_triangles(mesh.points);
  mesh.missing = keep_inside(mesh.faces, ring, mesh.points.size());
  return mesh.missing.empty() && covers_ring(mesh.points, ring, mesh.faces);
}

/// The sum over the triangles of a point: their areas, and their centres times their areas.
struct Pull {
  double x = 0, y = 0, weight = 0;
};

/// Adds the pull of one triangle to its corners. The centre is that of the circumcircle, or the
/// centroid where the former lies outside of the triangle. Coordinates are relative to the first
/// corner, so that squares keep their digits.
void pull_corners(std::span<const GridPoint> points, const Triangle& t, std::vector<Pull>& pulls) {
  const GridPoint a = points[at(t[0])], b = points[at(t[1])], c = points[at(t[2])];
  const auto bx = static_cast<double>(b.x - a.x), by = static_cast<double>(b.y - a.y);
  const auto cx = static_cast<double>(c.x - a.x), cy = static_cast<double>(c.y - a.y);
  const double area2 = bx * cy - by * cx;
  const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy, bc = bx * cx + by * cy;

  // The circumcentre is inside where no angle is obtuse.
  const bool acute = bc > 0 && b2 - bc > 0 && c2 - bc > 0;
  const double x = acute ? (cy * b2 - by * c2) / (2 * area2) : (bx + cx) / 3;
  const double y = acute ? (bx * c2 - cx * b2) / (2 * area2) : (by + cy) / 3;

  for (const Index v : t) {
    const GridPoint p = points[at(v)];
    Pull& pull = pulls[at(v)];
    pull.x += area2 * (x - static_cast<double>(p.x - a.x));
    pull.y += area2 * (y - static_cast<double>(p.y - a.y));
    pull.weight += area2;
  }
}

/// One round: every point inside moves towards the mean of the centres around it.
void move_points(OutlineMesh& mesh, Index ring) {
  std::vector<Pull> pulls(mesh.points.size());
  for (const Triangle& t : mesh.faces) pull_corners(mesh.points, t, pulls);
  for (std::size_t v = at(ring); v < mesh.points.size(); ++v) {
    const Pull& pull = pulls[v];
    if (!(pull.weight > 0)) continue;
    mesh.points[v].x += std::llround(kRelaxation * pull.x / pull.weight);
    mesh.points[v].y += std::llround(kRelaxation * pull.y / pull.weight);
  }
}

}  // namespace

std::vector<Triangle> delaunay_triangles(std::span<const GridPoint> points) {
  if (points.empty()) return {};
  // The library takes 32-bit numbers; differences on the grid fit them.
  GridPoint low = points[0];
  for (const GridPoint& p : points) low = {std::min(low.x, p.x), std::min(low.y, p.y)};
  std::vector<boost::polygon::point_data<int>> sites;
  sites.reserve(points.size());
  for (const GridPoint& p : points)
    sites.emplace_back(static_cast<int>(p.x - low.x), static_cast<int>(p.y - low.y));
  boost::polygon::voronoi_diagram<double> diagram;
  boost::polygon::construct_voronoi(sites.begin(), sites.end(), &diagram);

  // Around each vertex of the diagram are the cells of the points on one empty circle, counter-
  // clockwise: they become a fan.
  std::vector<Triangle> faces;
  std::vector<Index> circle;
  for (const auto& vertex : diagram.vertices()) {
    circle.clear();
    const auto* edge = vertex.incident_edge();
    do {
      circle.push_back(static_cast<Index>(edge->cell()->source_index()));
      edge = edge->rot_next();
    } while (edge != vertex.incident_edge());

    for (std::size_t i = 1; i + 1 < circle.size(); ++i) {
      const Triangle t{circle[0], circle[i], circle[i + 1]};
      if (turn(points[at(t[0])], points[at(t[1])], points[at(t[2])]) > 0) faces.push_back(t);
    }
  }
  return faces;
}

OutlineMesh mesh_outline(std::span<const GridPoint> ring, double edge_length) {
  OutlineMesh mesh;
  mesh.points.assign(ring.begin(), ring.end());
  const std::vector<GridPoint> inside = fill_outline(ring, edge_length);
  mesh.points.insert(mesh.points.end(), inside.begin(), inside.end());
  const auto count = static_cast<Index>(ring.size());
  if (!triangulate(mesh, count)) {
    mesh.faces.clear();
    return mesh;
  }

  // A round after which an edge of the ring is missing, or a point has left the inside, is not
  // taken.
  for (int round = 0; round < kRounds; ++round) {
    OutlineMesh next = mesh;
    move_points(next, count);
    if (!triangulate(next, count)) break;
    mesh = std::move(next);
  }
  return mesh;
}

}  // namespace icloth
