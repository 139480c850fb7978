// Procedural meshes: counts, quality, orientation, closedness.
#include "sim/scene/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "sim/files/mesh_io.h"

namespace icloth {
namespace {

Vec3d at(const std::vector<Vec3d>& points, Index i) { return points[static_cast<std::size_t>(i)]; }

double volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const Triangle& f : mesh.faces)
    six += dot(at(mesh.positions, f[0]), cross(at(mesh.positions, f[1]), at(mesh.positions, f[2])));
  return six / 6;
}

double area(const std::vector<Vec3d>& points, const Triangle& f) {
  return 0.5 *
         norm(cross(at(points, f[1]) - at(points, f[0]), at(points, f[2]) - at(points, f[0])));
}

double total_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& f : mesh.faces) sum += area(mesh.positions, f);
  return sum;
}

/// Directed edges that have no partner in the other direction, or occur twice.
std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::array<Index, 2>, int> count;
  for (const Triangle& f : mesh.faces)
    for (std::size_t c = 0; c < 3; ++c) ++count[{f[c], f[(c + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, n] : count)
    if (n != 1 || !count.contains({edge[1], edge[0]})) ++open;
  return open;
}

double smallest_angle(const std::vector<Vec3d>& points, const std::vector<Triangle>& faces) {
  double smallest = 180;
  for (const Triangle& f : faces)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d a = at(points, f[(c + 1) % 3]) - at(points, f[c]);
      const Vec3d b = at(points, f[(c + 2) % 3]) - at(points, f[c]);
      smallest = std::min(smallest, std::atan2(norm(cross(a, b)), dot(a, b)));
    }
  return smallest * 180 / std::numbers::pi;
}

TEST(Shapes, GridMeetsItsTriangleCount) {
  for (Index wanted : {2, 10, 120, 2000, 66666, 500000}) {
    GridShape shape{1.7, 0.22, wanted};
    const GridMesh grid = make_grid(shape);
    const auto got = static_cast<double>(grid.mesh.faces.size());
    EXPECT_LT(std::abs(got - wanted), std::max(8.0, 0.01 * wanted)) << wanted;
    EXPECT_NO_THROW(check_cloth_mesh(grid.mesh, "grid"));
  }
}

TEST(Shapes, GridIsTheFlatRectangleAtRest) {
  const GridMesh grid = make_grid({0.9, 0.6, 3000});
  EXPECT_NEAR(total_area(grid.mesh), 0.54, 1e-12);
  EXPECT_GE(smallest_angle(grid.rest, grid.mesh.faces), 29);  // the halved ones at the borders
  for (std::size_t f = 0; f < grid.mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d rest = at(grid.rest, grid.mesh.faces[f][c]);
      ASSERT_EQ(rest, (Vec3d{grid.mesh.uv[f][c].x, grid.mesh.uv[f][c].y, 0}));
    }
}

TEST(Shapes, GridFacesTheFront) {
  const GridMesh upright = make_grid({1, 1, 50});
  GridShape lying{1, 1, 50};
  lying.horizontal = true;
  const GridMesh flat = make_grid(lying);
  const auto normal = [](const GridMesh& g, const Triangle& f) {
    const auto& x = g.mesh.positions;
    return normalized(cross(at(x, f[1]) - at(x, f[0]), at(x, f[2]) - at(x, f[0])));
  };
  for (const Triangle& f : upright.mesh.faces) EXPECT_NEAR(normal(upright, f).z, 1, 1e-12);
  for (const Triangle& f : flat.mesh.faces) EXPECT_NEAR(normal(flat, f).y, 1, 1e-12);
}

TEST(Shapes, BentGridIsAlmostUnstretched) {
  GridShape shape{1.7, 0.22, 10000};
  shape.bend_radius = 0.12;
  const GridMesh grid = make_grid(shape);
  double worst = 0;
  for (const Triangle& f : grid.mesh.faces)
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = f[c], b = f[(c + 1) % 3];
      const double rest = norm(at(grid.rest, b) - at(grid.rest, a));
      const double now = norm(at(grid.mesh.positions, b) - at(grid.mesh.positions, a));
      worst = std::max(worst, std::abs(now / rest - 1));
    }
  EXPECT_LT(worst, 4e-4);  // chords of the arc: (edge / radius)² / 24
  const Vec3d left = at(grid.mesh.positions, grid_vertices(grid, "left_end").at(0));
  const Vec3d right = at(grid.mesh.positions, grid_vertices(grid, "right_end").at(0));
  EXPECT_NEAR(left.x, -0.12, 1e-9);
  EXPECT_NEAR(right.x, 0.12, 1e-9);
  EXPECT_NEAR(left.z, 0.85 - 0.06 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(left.z, right.z, 1e-12);
}

TEST(Shapes, VerticesOfAGridHaveNames) {
  const GridMesh grid = make_grid({2, 1, 500});
  const auto only = [&](const char* name) {
    return at(grid.rest, grid_vertices(grid, name).at(0));
  };
  EXPECT_EQ(only("bottom_left"), (Vec3d{0, 0, 0}));
  EXPECT_EQ(only("bottom_right"), (Vec3d{2, 0, 0}));
  EXPECT_EQ(only("top_left"), (Vec3d{0, 1, 0}));
  EXPECT_EQ(only("top_right"), (Vec3d{2, 1, 0}));
  EXPECT_NEAR(only("left_end").y, 0.5, 0.05);
  EXPECT_NEAR(only("center").x, 1, 0.1);
  for (Index v : grid_vertices(grid, "top")) EXPECT_EQ(at(grid.rest, v).y, 1);
  for (Index v : grid_vertices(grid, "right")) EXPECT_EQ(at(grid.rest, v).x, 2);
  EXPECT_GT(grid_vertices(grid, "left").size(), 5u);
  for (std::string_view name : grid_vertex_names())
    EXPECT_FALSE(grid_vertices(grid, name).empty()) << name;
  EXPECT_TRUE(grid_vertices(grid, "nowhere").empty());
}

TEST(Shapes, SphereIsClosedAndRound) {
  const TriangleMesh ball = make_sphere(0.25, 4000);
  EXPECT_EQ(ball.faces.size(), 4500u);
  EXPECT_EQ(open_edges(ball), 0u);
  for (Vec3d p : ball.positions) EXPECT_NEAR(norm(p), 0.25, 1e-12);
  EXPECT_NEAR(volume(ball), 4.0 / 3 * std::numbers::pi * std::pow(0.25, 3), 2e-4);
  EXPECT_GT(smallest_angle(ball.positions, ball.faces), 40);
}

TEST(Shapes, ClosedBodiesEncloseTheirVolume) {
  const double pi = std::numbers::pi;
  const TriangleMesh capsule = make_capsule(0.1, 0.5, 3000);
  EXPECT_EQ(open_edges(capsule), 0u);
  EXPECT_NEAR(volume(capsule), pi * 0.01 * 0.5 + 4.0 / 3 * pi * 0.001, 2e-4);
  EXPECT_GT(smallest_angle(capsule.positions, capsule.faces), 25);

  const TriangleMesh box = make_box({1, 0.5, 0.25}, 0.1);
  EXPECT_EQ(open_edges(box), 0u);
  EXPECT_NEAR(volume(box), 0.125, 1e-12);

  const TriangleMesh funnel = make_funnel({0.5, 0.1, 0.4, 0.2, 0.01, 0.03});
  EXPECT_EQ(open_edges(funnel), 0u);
  // Walls of the cone and the pipe: differences of frustums and cylinders.
  const auto frustum = [&](double a, double b) { return pi / 3 * 0.4 * (a * a + a * b + b * b); };
  const double wall = frustum(0.51, 0.11) - frustum(0.5, 0.1) + pi * 0.2 * (0.0121 - 0.01);
  EXPECT_NEAR(volume(funnel), wall, 0.02 * wall);
}

TEST(Shapes, CapsuleWithoutCylinderIsASphere) {
  const TriangleMesh ball = make_capsule(0.2, 0, 500);
  EXPECT_EQ(open_edges(ball), 0u);
  for (Vec3d p : ball.positions) EXPECT_NEAR(norm(p), 0.2, 1e-12);
}

TEST(Shapes, PlaneFacesUp) {
  const TriangleMesh plane = make_plane(2, 1, 0.25);
  EXPECT_NEAR(total_area(plane), 2, 1e-12);
  const Triangle f = plane.faces.front();
  const Vec3d normal = cross(at(plane.positions, f[1]) - at(plane.positions, f[0]),
                             at(plane.positions, f[2]) - at(plane.positions, f[0]));
  EXPECT_GT(normal.y, 0);
}

TEST(Shapes, SubdivisionKeepsShapeAndOldVertices) {
  GridMesh grid = make_grid({1, 1, 40});
  const TriangleMesh coarse = grid.mesh;
  subdivide(grid.mesh, grid.rest);
  EXPECT_EQ(grid.mesh.faces.size(), 4 * coarse.faces.size());
  EXPECT_EQ(grid.mesh.uv.size(), grid.mesh.faces.size());
  EXPECT_EQ(grid.rest.size(), grid.mesh.positions.size());
  EXPECT_NEAR(total_area(grid.mesh), 1, 1e-12);
  for (std::size_t v = 0; v < coarse.positions.size(); ++v)
    EXPECT_EQ(grid.mesh.positions[v], coarse.positions[v]);
  TriangleMesh ball = make_sphere(1, 80);
  std::vector<Vec3d> none;
  subdivide(ball, none);
  EXPECT_EQ(open_edges(ball), 0u);
}

}  // namespace
}  // namespace icloth
