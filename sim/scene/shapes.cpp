#include "sim/scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace icloth {
namespace {

constexpr double kPi = std::numbers::pi;

/// Vertex at one position, made once however many patches share it.
class Welder {
 public:
  explicit Welder(TriangleMesh& mesh) : mesh_(&mesh) {}

  Index add(Vec3d p) {
    // Neighbouring patches compute shared points from other corners: equal up to rounding.
    const auto key = [](double x) { return static_cast<std::int64_t>(std::llround(x * 1e8)); };
    const auto [entry, is_new] = index_.try_emplace({key(p.x), key(p.y), key(p.z)},
                                                    static_cast<Index>(mesh_->positions.size()));
    if (is_new) mesh_->positions.push_back(p);
    return entry->second;
  }

 private:
  TriangleMesh* mesh_;
  std::map<std::array<std::int64_t, 3>, Index> index_;
};

Index steps(double length, double edge) {
  return std::max<Index>(1, static_cast<Index>(std::lround(length / edge)));
}

/// Parallelogram of nu × nv cells with alternating diagonals; its front is where du × dv points.
void add_patch(TriangleMesh& mesh, Welder& welder, Vec3d corner, Vec3d du, Vec3d dv, Index nu,
               Index nv) {
  const auto point = [&](Index i, Index j) {
    return welder.add(corner + (static_cast<double>(i) / nu) * du +
                      (static_cast<double>(j) / nv) * dv);
  };
  for (Index j = 0; j < nv; ++j) {
    for (Index i = 0; i < nu; ++i) {
      const Index a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1),
                  d = point(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
      } else {
        mesh.faces.insert(mesh.faces.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
}

/// Vertices at equal angles about y.
struct Ring {
  Index first = 0, count = 1;
  double phase = 0;  ///< angle of the first vertex [turns]

  Index vertex(Index i) const { return first + i % count; }
  /// Middle between vertices i and i + 1 [turns]; a pole never advances.
  double middle(Index i) const { return count == 1 ? 2 : phase + (i + 0.5) / count; }
};

/// Triangles between two rings, the next one always at the ring that is behind.
void connect(const Ring& lower, const Ring& upper, std::vector<Triangle>& faces) {
  // A pole has one vertex, so the strip to it is a fan of triangles.
  const Index lower_steps = lower.count == 1 ? 0 : lower.count;
  const Index upper_steps = upper.count == 1 ? 0 : upper.count;

  for (Index i = 0, j = 0; i < lower_steps || j < upper_steps;) {
    const bool at_lower =
        j == upper_steps || (i < lower_steps && lower.middle(i) < upper.middle(j));
    if (at_lower) {
      faces.push_back({lower.vertex(i), lower.vertex(i + 1), upper.vertex(j)});
      ++i;
    } else {
      faces.push_back({lower.vertex(i), upper.vertex(j + 1), upper.vertex(j)});
      ++j;
    }
  }
}

/// Rings about y through the profile's points (radius, height), vertices about `edge` apart and
/// every second ring turned by half a step. A radius of 0 is a pole: one vertex.
TriangleMesh revolve(const std::vector<Vec2d>& profile, double edge, bool closed_profile) {
  TriangleMesh mesh;
  std::vector<Ring> rings;

  // Every second ring starts half a step later, which makes the triangles nearly equilateral.
  for (const auto& [radius, height] : profile) {
    Ring ring{static_cast<Index>(mesh.positions.size())};
    if (radius > 0) ring.count = std::max<Index>(6, steps(2 * kPi * radius, edge));
    ring.phase = rings.size() % 2 == 1 ? 0.5 / ring.count : 0;
    for (Index i = 0; i < ring.count; ++i) {
      const double angle = 2 * kPi * (ring.phase + static_cast<double>(i) / ring.count);
      mesh.positions.push_back({radius * std::sin(angle), height, radius * std::cos(angle)});
    }
    rings.push_back(ring);
  }

  // A closed profile, such as the wall of the funnel, has its last ring next to its first one.
  for (std::size_t i = 1; i < rings.size(); ++i) connect(rings[i - 1], rings[i], mesh.faces);
  if (closed_profile) connect(rings.back(), rings.front(), mesh.faces);
  return mesh;
}

/// Appends the points of the straight profile piece from a (exclusive) to b (inclusive).
void add_profile(std::vector<Vec2d>& profile, Vec2d a, Vec2d b, double edge) {
  const Index count = steps(std::hypot(b.x - a.x, b.y - a.y), edge);
  for (Index i = 1; i <= count; ++i)
    profile.push_back(a + (static_cast<double>(i) / count) * (b - a));
}

}  // namespace

TriangleMesh make_sphere(double radius, Index triangles) {
  // An icosahedron has 20 faces; its corners lie on three golden rectangles.
  const Index n = std::max<Index>(1, static_cast<Index>(std::ceil(std::sqrt(triangles / 20.0))));
  const double g = std::numbers::phi;
  const std::array<Vec3d, 12> corners{{{-1, g, 0},
                                       {1, g, 0},
                                       {-1, -g, 0},
                                       {1, -g, 0},
                                       {0, -1, g},
                                       {0, 1, g},
                                       {0, -1, -g},
                                       {0, 1, -g},
                                       {g, 0, -1},
                                       {g, 0, 1},
                                       {-g, 0, -1},
                                       {-g, 0, 1}}};
  constexpr std::size_t kFaces[20][3] = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};

  // Each face becomes a triangular lattice that is projected onto the sphere. Neighbouring faces
  // share the vertices along their common edge.
  TriangleMesh mesh;
  Welder welder(mesh);
  for (const auto& face : kFaces) {
    const Vec3d a = corners[face[0]], b = corners[face[1]], c = corners[face[2]];
    const auto point = [&](Index i, Index j) {
      const Vec3d p =
          a + (1.0 / n) * (static_cast<double>(i) * (b - a) + static_cast<double>(j) * (c - a));
      return welder.add(normalized(p));
    };

    // The lattice has triangles that point as the face does, and between them those turned over.
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i + j < n; ++i) {
        mesh.faces.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
        if (i + j + 1 < n)
          mesh.faces.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
      }
    }
  }

  for (Vec3d& p : mesh.positions) p = radius * p;
  return mesh;
}

TriangleMesh make_capsule(double radius, double length, Index triangles) {
  // The area and the wanted number of triangles give the edge of an equilateral one, and its height
  // is the distance of rings.
  const double area = 2 * kPi * radius * length + 4 * kPi * radius * radius;
  const double edge = std::sqrt(area / std::max<Index>(triangles, 16) * 4 / std::numbers::sqrt3);
  const double band = edge * std::numbers::sqrt3 / 2;
  const Index cap = std::max<Index>(2, steps(kPi / 2 * radius, band));

  // The profile goes from the south pole over the cylinder to the north pole.
  std::vector<Vec2d> profile;
  for (Index i = 0; i <= cap; ++i) {
    const double angle = kPi / 2 * i / cap;
    profile.push_back(
        {i == 0 ? 0 : radius * std::sin(angle), -length / 2 - radius * std::cos(angle)});
  }
  if (length > 0) add_profile(profile, profile.back(), {radius, length / 2}, band);
  for (Index i = cap - 1; i >= 0; --i) {
    const double angle = kPi / 2 * i / cap;
    profile.push_back(
        {i == 0 ? 0 : radius * std::sin(angle), length / 2 + radius * std::cos(angle)});
  }
  return revolve(profile, edge, false);
}

TriangleMesh make_box(Vec3d size, double edge) {
  TriangleMesh mesh;
  Welder welder(mesh);
  const Vec3d x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z}, low = -0.5 * size,
                                                                 high = 0.5 * size;
  const Index nx = steps(size.x, edge), ny = steps(size.y, edge), nz = steps(size.z, edge);

  // Opposite sides are made from opposite corners with reversed directions, so that all face
  // outwards.
  add_patch(mesh, welder, low, y, x, ny, nx);
  add_patch(mesh, welder, low, z, y, nz, ny);
  add_patch(mesh, welder, low, x, z, nx, nz);
  add_patch(mesh, welder, high, -x, -y, nx, ny);
  add_patch(mesh, welder, high, -y, -z, ny, nz);
  add_patch(mesh, welder, high, -z, -x, nz, nx);
  return mesh;
}

TriangleMesh make_plane(double width, double depth, double edge) {
  TriangleMesh mesh;
  Welder welder(mesh);
  add_patch(mesh, welder, {-width / 2, 0, -depth / 2}, {0, 0, depth}, {width, 0, 0},
            steps(depth, edge), steps(width, edge));
  return mesh;
}

TriangleMesh make_funnel(const FunnelShape& shape) {
  const double wall = shape.wall, band = shape.edge * std::numbers::sqrt3 / 2;
  const double pipe_end = -shape.cone_height - shape.pipe_length;

  // Counter-clockwise in (radius, height): up the outer wall, over the rim, down the inner wall.
  const Vec2d corners[] = {{shape.bottom_radius + wall, pipe_end},
                           {shape.bottom_radius + wall, -shape.cone_height},
                           {shape.top_radius + wall, 0},
                           {shape.top_radius, 0},
                           {shape.bottom_radius, -shape.cone_height},
                           {shape.bottom_radius, pipe_end}};

  std::vector<Vec2d> profile;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec2d a = corners[i], b = corners[(i + 1) % 6];
    if (std::hypot(b.x - a.x, b.y - a.y) > 0) add_profile(profile, a, b, band);
  }
  return revolve(profile, shape.edge, true);
}

void subdivide(TriangleMesh& mesh, std::vector<Vec3d>& rest) {
  // An edge is halved once, however many faces it has, so that the mesh stays connected.
  std::map<std::array<Index, 2>, Index> middle_of;
  const auto at = [](auto& list, Index i) -> auto& { return list[static_cast<std::size_t>(i)]; };
  const auto middle = [&](Index a, Index b) {
    const auto [entry, is_new] = middle_of.try_emplace({std::min(a, b), std::max(a, b)},
                                                       static_cast<Index>(mesh.positions.size()));
    if (is_new) {
      mesh.positions.push_back(0.5 * (at(mesh.positions, a) + at(mesh.positions, b)));
      if (!rest.empty()) rest.push_back(0.5 * (at(rest, a) + at(rest, b)));
    }
    return entry->second;
  };

  // Each face becomes three at its corners and one in the middle, with the same orientation.
  const std::vector<Triangle> faces = std::move(mesh.faces);
  const std::vector<std::array<Vec2d, 3>> uv = std::move(mesh.uv);
  mesh.faces.clear();
  mesh.uv.clear();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c] = faces[f];
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.faces.insert(mesh.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});

    // Material coordinates belong to faces: at a seam the two sides halve them independently.
    if (uv.empty()) continue;
    const auto [ua, ub, uc] = uv[f];
    const Vec2d uab = 0.5 * (ua + ub), ubc = 0.5 * (ub + uc), uca = 0.5 * (uc + ua);
    mesh.uv.insert(mesh.uv.end(),
                   {{ua, uab, uca}, {uab, ub, ubc}, {uca, ubc, uc}, {uab, ubc, uca}});
  }
}

}  // namespace icloth
