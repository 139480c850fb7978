#include "sim/scene/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "sim/files/error.h"

using namespace icloth;

namespace {

constexpr double kPi = std::numbers::pi;

/// Two triangles over one edge, the second folded up by `angle` about it.
Cloth folded_pair(double angle) {
  Cloth cloth;
  cloth.name = "pair";
  cloth.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {1, std::sin(angle), std::cos(angle)}};
  cloth.mesh.faces = {{0, 1, 2}, {1, 0, 3}};
  cloth.material.density = 0.2;
  return cloth;
}

/// n × n quads in the xz plane, side 1, with uv.
Cloth grid(int n, bool uv) {
  Cloth cloth;
  cloth.name = "grid";
  const auto id = [&](int i, int j) { return static_cast<Index>(i * (n + 1) + j); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) cloth.mesh.positions.push_back({double(i) / n, 0, double(j) / n});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      cloth.mesh.faces.push_back({id(i, j), id(i, j + 1), id(i + 1, j + 1)});
      cloth.mesh.faces.push_back({id(i, j), id(i + 1, j + 1), id(i + 1, j)});
    }
  if (uv)
    for (const Triangle& t : cloth.mesh.faces) {
      std::array<Vec2d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d p = cloth.mesh.positions[static_cast<std::size_t>(t[k])];
        corners[k] = {p.z, p.x};
      }
      cloth.mesh.uv.push_back(corners);
    }
  return cloth;
}

Obstacle triangle_obstacle() {
  Obstacle obstacle;
  obstacle.name = "body";
  obstacle.mesh.positions = {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  obstacle.mesh.faces = {{0, 1, 2}};
  return obstacle;
}

World world_of(std::vector<Cloth> cloths, std::vector<Obstacle> obstacles = {}) {
  Scene scene;
  scene.cloths = std::move(cloths);
  scene.obstacles = std::move(obstacles);
  return make_world(scene);
}

std::string error_of(Cloth cloth) {
  try {
    world_of({std::move(cloth)});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Deformation gradient columns of face f of a world at its start state.
std::array<Vec3d, 2> gradient(const World& world, std::size_t f) {
  const Triangle& t = world.face[f];
  const auto x = [&](std::size_t k) { return world.position[static_cast<std::size_t>(t[k])]; };
  const auto& r = world.face_inverse[f];
  const Vec3d a = x(1) - x(0), b = x(2) - x(0);
  return {r[0] * a + r[2] * b, r[1] * a + r[3] * b};
}

}  // namespace

TEST(World, CountsVerticesFacesAndEdges) {
  const World world = world_of({grid(4, false), folded_pair(0)}, {triangle_obstacle()});
  ASSERT_EQ(world.objects.size(), 3u);
  EXPECT_EQ(world.cloth_vertices, 29);
  EXPECT_EQ(world.vertices, 32);
  EXPECT_EQ(world.cloth_faces, 34);
  EXPECT_EQ(world.faces, 35);
  EXPECT_EQ(world.cloth_edges, 56 + 5);  // Euler: E = V + F − 1
  EXPECT_EQ(world.edges, 56 + 5 + 3);
  EXPECT_EQ(world.objects[1].first_vertex, 25);
  EXPECT_EQ(world.objects[2].first_face, 34);
  EXPECT_FALSE(world.objects[2].cloth);
  EXPECT_EQ(world.object[24], 0);
  EXPECT_EQ(world.object[25], 1);
  EXPECT_EQ(world.face[34], (Triangle{29, 30, 31}));
  EXPECT_EQ(world.position[31].y, 1);
  EXPECT_EQ(world.hinges.size(), 40u + 1u);  // inner edges: 56 − 16, and one
  for (const auto& range : {std::pair{0, 56}, {56, 61}, {61, 64}})
    EXPECT_TRUE(
        std::is_sorted(world.edge.begin() + range.first, world.edge.begin() + range.second));
  for (const auto& e : world.edge) EXPECT_LT(e[0], e[1]);
  EXPECT_NEAR(world.median_edge, 0.25, 1e-12);
}

TEST(World, MassesAndAreasAddUp) {
  Cloth cloth = grid(5, true);
  cloth.material.density = 0.3;
  cloth.pins = {0, 5};
  const World world = world_of({cloth});
  const auto sum = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0);
  };
  EXPECT_NEAR(sum(world.mass), 0.3, 1e-12);
  EXPECT_NEAR(sum(world.area), 1, 1e-12);
  EXPECT_NEAR(sum(world.face_area), 1, 1e-12);
  EXPECT_NEAR(sum(world.edge_area), 1, 1e-12);  // a third of a face for each of its edges
  EXPECT_EQ(std::count(world.pinned.begin(), world.pinned.end(), 1), 2);
  EXPECT_TRUE(world.pinned[0] && world.pinned[5]);
}

TEST(World, RestAngleHasTheSignOfTheFold) {
  for (const double angle : {0.0, 0.3, -0.3, 1.5, -2.5}) {
    const World world = world_of({folded_pair(angle)});
    ASSERT_EQ(world.hinges.size(), 1u);
    const Hinge& hinge = world.hinges[0];
    EXPECT_EQ(hinge.vertices, (std::array<Index, 4>{0, 1, 2, 3}));
    EXPECT_NEAR(std::fabs(hinge.rest_angle), std::fabs(angle), 1e-12);
    // ê·(n₀×n₁) with ê = x, n₀ = y: the second normal leans to +z for a fold upwards.
    const Vec3d n0{0, 1, 0}, n1{0, std::cos(angle), -std::sin(angle)};
    EXPECT_NEAR(hinge.rest_angle, std::atan2(cross(n0, n1).x, dot(n0, n1)), 1e-12);
    EXPECT_NEAR(hinge.rest_length, 1, 1e-12);
    EXPECT_NEAR(hinge.rest_area, 1, 1e-12);
    EXPECT_EQ(hinge.weight, 1);
  }
}

TEST(World, RestShapeGivesTheAngleNotTheStart) {
  Cloth cloth = folded_pair(1.0);
  cloth.rest = folded_pair(0.25).mesh.positions;
  const World world = world_of({cloth});
  EXPECT_NEAR(std::fabs(world.hinges[0].rest_angle), 0.25, 1e-12);
  EXPECT_EQ(world.position[3].y, std::sin(1.0));
  EXPECT_EQ(world.rest[3].y, std::sin(0.25));
}

TEST(World, AngleDoesNotDependOnTheOrientationOfTheSecondFace) {
  Cloth cloth = folded_pair(0.7);
  const double expected = world_of({cloth}).hinges[0].rest_angle;
  cloth.mesh.faces[1] = {0, 1, 3};
  EXPECT_NEAR(world_of({cloth}).hinges[0].rest_angle, expected, 1e-12);
}

TEST(World, RestAnglesAreFlatWhereThatIsAskedFor) {
  Cloth cloth = folded_pair(0.7);
  cloth.flat_angles = true;
  EXPECT_EQ(world_of({cloth}).hinges[0].rest_angle, 0);
}

TEST(World, SeamsRestFlat) {
  Cloth cloth = folded_pair(0.7);
  cloth.mesh.uv = {{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 0}, {0, 0}, {1, -1}}}};
  EXPECT_NEAR(std::fabs(world_of({cloth}).hinges[0].rest_angle), 0.7, 1e-12);
  for (Vec2d& u : cloth.mesh.uv[1]) u.x += 3;  // another panel of the pattern
  const World world = world_of({cloth});
  ASSERT_EQ(world.hinges.size(), 1u);
  EXPECT_EQ(world.hinges[0].rest_angle, 0);
}

TEST(World, DeformationGradientOfTheRestStateIsOrthonormal) {
  Cloth tilted = folded_pair(0.6);
  for (const Cloth& cloth : {grid(3, true), grid(3, false), tilted}) {
    const World world = world_of({cloth});
    for (std::size_t f = 0; f < world.face_inverse.size(); ++f) {
      const auto [u, v] = gradient(world, f);
      EXPECT_NEAR(norm(u), 1, 1e-12);
      EXPECT_NEAR(norm(v), 1, 1e-12);
      EXPECT_NEAR(dot(u, v), 0, 1e-12);
    }
  }
}

TEST(World, WeftFollowsUvOrTheWorldAxis) {
  EXPECT_NEAR(gradient(world_of({grid(3, true)}), 0)[0].z, 1, 1e-12);   // u grows along z
  EXPECT_NEAR(gradient(world_of({grid(3, false)}), 0)[0].x, 1, 1e-12);  // no uv: along x
  Cloth across;  // in the yz plane, where x has no direction: z
  across.mesh.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  across.mesh.faces = {{0, 1, 2}};
  EXPECT_NEAR(gradient(world_of({across}), 0)[0].z, 1, 1e-12);
}

TEST(World, HingeDirectionIsFoldedToAQuarterTurn) {
  const World world = world_of({grid(2, true)});
  for (const Hinge& hinge : world.hinges) {
    const Vec3d edge = world.rest[static_cast<std::size_t>(hinge.vertices[1])] -
                       world.rest[static_cast<std::size_t>(hinge.vertices[0])];
    const double expected = std::atan2(std::fabs(edge.x), std::fabs(edge.z));  // weft is z
    EXPECT_NEAR(hinge.direction, expected, 1e-12);
    EXPECT_GE(hinge.direction, 0);
    EXPECT_LE(hinge.direction, kPi / 2);
  }
}

TEST(World, TextureCoordinatesGiveTheDirectionOnly) {
  Cloth cloth = grid(3, true);
  for (auto& corners : cloth.mesh.uv)
    for (Vec2d& u : corners) u = 40.0 * u;
  const World world = world_of({cloth});
  const auto [u, v] = gradient(world, 4);
  EXPECT_NEAR(u.z, 1, 1e-12);
  EXPECT_NEAR(norm(v), 1, 1e-12);
  EXPECT_NEAR(world.face_area[0], 1.0 / 18, 1e-12);
}

TEST(World, ThreeFacesOnAnEdgeShareTheBending) {
  Cloth cloth = folded_pair(0);
  cloth.mesh.positions.push_back({0, 1, 0.1});
  cloth.mesh.faces.push_back({0, 1, 4});
  const World world = world_of({cloth});
  ASSERT_EQ(world.hinges.size(), 3u);
  for (const Hinge& hinge : world.hinges) EXPECT_EQ(hinge.weight, 0.5);
  EXPECT_EQ(world.edges, 7);
}

TEST(World, RefusesWhatCannotBeSimulated) {
  Cloth cloth = folded_pair(0);
  cloth.mesh.positions.push_back({9, 9, 9});
  EXPECT_NE(error_of(cloth).find("'pair', vertex 4: used by no face"), std::string::npos);
  cloth = folded_pair(0);
  cloth.rest = cloth.mesh.positions;
  cloth.rest[3] = {0.5, 0, 0};
  EXPECT_NE(error_of(cloth).find("'pair', face 1: rest area"), std::string::npos);
  cloth = folded_pair(0);
  cloth.rest.resize(3);
  EXPECT_NE(error_of(cloth).find("expected 4"), std::string::npos);
  cloth = folded_pair(0);
  cloth.pins = {7};
  EXPECT_NE(error_of(cloth).find("pinned vertex 7"), std::string::npos);
  cloth = folded_pair(0);
  cloth.mesh.faces[0][1] = 12;
  EXPECT_NE(error_of(cloth).find("face 0: vertex 12"), std::string::npos);
  cloth = folded_pair(0);
  cloth.material.density = 0;
  EXPECT_NE(error_of(cloth).find("density"), std::string::npos);
}
