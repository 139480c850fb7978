#include "sim/scene/repair_mesh.h"

#include <algorithm>
#include <cmath>

#include "kernels/distance.h"
#include "kernels/index.h"

namespace icloth {
namespace {

/// Lists of the rows that hold each column, in the order of the rows.
template <std::size_t N>
IndexLists transpose(std::span<const std::array<Index, N>> rows, std::size_t columns) {
  IndexLists lists;
  lists.first.assign(columns + 1, 0);
  for (const auto& row : rows)
    for (const Index column : row) ++lists.first[at(column) + 1];
  for (std::size_t c = 0; c < columns; ++c) lists.first[c + 1] += lists.first[c];
  lists.items.resize(N * rows.size());
  std::vector<Index> next(lists.first.begin(), lists.first.end() - 1);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const Index column : rows[r]) lists.items[at(next[at(column)]++)] = static_cast<Index>(r);
  return lists;
}

/// Whether the face goes along its edge k from the smaller to the larger vertex number.
bool goes_up(const Triangle& face, std::size_t k) { return face[k] < face[(k + 1) % 3]; }

/// Interior angle of a face at its corner k.
double corner_angle(const std::array<Vec3d, 3>& x, std::size_t k) {
  const Vec3d a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Normal of the surface at a point of a face. Weights of 0 put the point on an edge or a vertex.
/// The signs that it gives are right for every point outside (Bærentzen and Aanæs 2005).
Vec3d pseudo_normal(const RepairMesh& mesh, Index face, const std::array<double, 3>& w,
                    bool& on_border) {
  const Triangle& t = mesh.faces[at(face)];
  const auto zeros = std::ranges::count(w, 0.0);
  if (zeros == 0) return mesh.normal(face);

  // On an edge the faces of the edge count alike.
  if (zeros == 1) {
    const auto opposite = static_cast<std::size_t>(std::ranges::find(w, 0.0) - w.begin());
    const Index edge = mesh.face_edges[at(face)][(opposite + 1) % 3];
    on_border = mesh.edge_faces[edge].size() < 2;
    return mesh.edge_normal(edge);
  }

  // On a vertex the faces count by their angles there.
  const auto corner = static_cast<std::size_t>(std::ranges::max_element(w) - w.begin());
  Vec3d sum;
  for (const Index f : mesh.vertex_faces[t[corner]]) {
    const Triangle& other = mesh.faces[at(f)];
    const auto k = static_cast<std::size_t>(std::ranges::find(other, t[corner]) - other.begin());
    sum += corner_angle(mesh.corners(f), k) * mesh.normal(f);
    for (const std::size_t side : {k, (k + 2) % 3})
      on_border = on_border || mesh.edge_faces[mesh.face_edges[at(f)][side]].size() < 2;
  }
  return sum;
}

}  // namespace

RepairMesh::RepairMesh(const Scene& scene) {
  // Cloths come first, then obstacles where they are at time 0.
  for (const Cloth& cloth : scene.cloths) {
    const std::size_t first = x.size();
    add(cloth.mesh.positions, cloth.mesh.faces, 0);
    for (const Index pin : cloth.pins) free[first + at(pin)] = 0;
  }
  std::vector<Vec3d> pose;
  for (const Obstacle& obstacle : scene.obstacles) {
    obstacle.pose(0.0, pose);
    add(pose, obstacle.mesh.faces, -1);
  }
  start = base = x;

  // Turning a face changes the neighbourhoods only by the order of its edges.
  make_edges();
  turn_faces();
}

void RepairMesh::add(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                     int number) {
  // Single precision is what most builds compute in.
  const auto first = static_cast<Index>(x.size());
  for (const Vec3d& p : positions) x.push_back(convert<double>(convert<float>(p)));
  free.resize(x.size(), number < 0 ? 0 : 1);
  for (const Triangle& t : triangles) faces.push_back({t[0] + first, t[1] + first, t[2] + first});
  group.resize(faces.size(), number);
}

void RepairMesh::make_edges() {
  // The sides of all faces are sorted by their vertices, so that equal ones are neighbours.
  struct Side {
    std::array<Index, 2> vertices;
    Index face, k;
  };
  std::vector<Side> sides;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
      sides.push_back({{low, high}, static_cast<Index>(f), static_cast<Index>(k)});
    }
  std::ranges::sort(sides, {}, [](const Side& s) {
    return std::array{s.vertices[0], s.vertices[1], s.face, s.k};
  });

  // Each run of equal sides becomes an edge.
  face_edges.resize(faces.size());
  for (const Side& side : sides) {
    if (edges.empty() || edges.back() != side.vertices) edges.push_back(side.vertices);
    face_edges[at(side.face)][at(side.k)] = static_cast<Index>(edges.size()) - 1;
  }
  edge_faces = transpose<3>(face_edges, edges.size());
  vertex_faces = transpose<3>(faces, x.size());
}

void RepairMesh::turn_faces() {
  part.assign(x.size(), -1);
  std::vector<std::uint8_t> seen(faces.size(), 0);
  const auto turn = [&](Index f) {
    std::swap(faces[at(f)][1], faces[at(f)][2]);
    std::swap(face_edges[at(f)][0], face_edges[at(f)][2]);
  };
  for (std::size_t seed = 0; seed < faces.size(); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = 1;

    // A face that passes the common edge in the same direction as its neighbour is turned.
    std::vector<Index> part_faces{static_cast<Index>(seed)};
    std::size_t turned = 0;
    bool closed = true;
    for (std::size_t next = 0; next < part_faces.size(); ++next) {
      const Index f = part_faces[next];
      for (std::size_t k = 0; k < 3; ++k) {
        const Index edge = face_edges[at(f)][k];
        const auto both = edge_faces[edge];
        closed = closed && both.size() == 2;
        if (both.size() != 2) continue;
        const Index g = both[0] == f ? both[1] : both[0];
        if (seen[at(g)]) continue;
        seen[at(g)] = 1;
        part_faces.push_back(g);
        const auto& sides = face_edges[at(g)];
        const auto l = static_cast<std::size_t>(std::ranges::find(sides, edge) - sides.begin());
        if (goes_up(faces[at(g)], l) != goes_up(faces[at(f)], k)) continue;
        turn(g);
        ++turned;
      }
    }

    // The number of the first face names the part.
    for (const Index f : part_faces)
      for (const Index v : faces[at(f)]) part[at(v)] = static_cast<Index>(seed);

    // A closed part has to face outwards; an open one as most of its faces did.
    double volume = 0;
    const Vec3d origin = x[at(faces[seed][0])];
    for (const Index f : part_faces) {
      const auto c = corners(f);
      volume += dot(c[0] - origin, cross(c[1] - origin, c[2] - origin));
    }
    if (closed ? volume < 0 : 2 * turned > part_faces.size())
      std::ranges::for_each(part_faces, turn);
  }
}

std::array<Vec3d, 3> RepairMesh::corners(Index f) const {
  const Triangle& t = faces[at(f)];
  return {x[at(t[0])], x[at(t[1])], x[at(t[2])]};
}

Vec3d RepairMesh::normal(Index f) const {
  const auto c = corners(f);
  return normalized(cross(c[1] - c[0], c[2] - c[0]));
}

Vec3d RepairMesh::edge_normal(Index edge) const {
  Vec3d sum;
  for (const Index f : edge_faces[edge]) sum += normal(f);
  return sum;
}

SurfacePoint walk_to_closest(const RepairMesh& mesh, Vec3d p, Index from) {
  const auto closest_in = [&](Index f) {
    const auto c = mesh.corners(f);
    return closest_point_triangle(p, c[0], c[1], c[2]);
  };

  // The walk goes from face to face as long as one around the present face is closer.
  Index face = from;
  TrianglePoint<double> best = closest_in(face);
  for (bool moved = true; moved;) {
    moved = false;
    const Triangle around = mesh.faces[at(face)];
    for (const Index v : around)
      for (const Index f : mesh.vertex_faces[v]) {
        const TrianglePoint<double> candidate = closest_in(f);
        if (!(candidate.distance2 < best.distance2)) continue;
        best = candidate;
        face = f;
        moved = true;
      }
  }

  // The normal at the closest point decides the side. A point next to an edge or a vertex counts as
  // on it.
  SurfacePoint point;
  point.face = face;
  constexpr double on_feature = 1e-6;
  for (std::size_t k = 0; k < 3; ++k) point.w[k] = best.w[k] < on_feature ? 0.0 : best.w[k];
  const auto c = mesh.corners(face);
  const Vec3d gap = p - (point.w[0] * c[0] + point.w[1] * c[1] + point.w[2] * c[2]);
  const Vec3d up = pseudo_normal(mesh, face, point.w, point.beyond);
  const double distance = norm(gap);
  const double side = dot(gap, up) < 0 ? -1 : 1;
  point.height = side * distance;
  const bool inside = std::ranges::count(point.w, 0.0) == 0;
  const bool plain = inside || !(distance > 1e-9);
  point.normal = plain ? normalized(up) : (side / distance) * gap;
  return point;
}

}  // namespace icloth
