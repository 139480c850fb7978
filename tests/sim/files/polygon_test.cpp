// Polygons of mesh files, cut into triangles.
#include "sim/files/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "sim/files/mesh_formats.h"
#include "sim/files/ring_crossings.h"

namespace icloth {
namespace {

Vec3d corner(const std::vector<Vec3d>& polygon, Index i) {
  return polygon[static_cast<std::size_t>(i)];
}

Vec3d area_vector(const std::vector<Vec3d>& polygon) {
  Vec3d sum{};
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += 0.5 * cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum;
}

double area(const std::vector<Vec3d>& polygon, const Triangle& t) {
  const Vec3d a = corner(polygon, t[0]);
  return 0.5 * norm(cross(corner(polygon, t[1]) - a, corner(polygon, t[2]) - a));
}

std::vector<Triangle> cut(const std::vector<Vec3d>& polygon) {
  std::vector<Triangle> triangles;
  EXPECT_EQ(cut_polygon(polygon, triangles), "");
  return triangles;
}

/// In the xy plane: whether a ray from the point to the right crosses the border an odd number of
/// times.
bool holds(const std::vector<Vec3d>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

/// Every point of the polygon lies in exactly one triangle and every other point in none; all
/// triangles turn as the polygon does, none is flat.
void expect_covered_once(const std::vector<Vec3d>& polygon, unsigned seed) {
  const std::vector<Triangle> triangles = cut(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  const Vec3d normal = area_vector(polygon);
  double sum = 0;
  for (const Triangle& t : triangles) {
    const std::vector<Vec3d> one{corner(polygon, t[0]), corner(polygon, t[1]),
                                 corner(polygon, t[2])};
    EXPECT_GT(dot(area_vector(one), normal), 0);
    EXPECT_GT(area(polygon, t), 1e-7 * norm(normal));
    sum += area(polygon, t);
  }
  EXPECT_NEAR(sum, norm(normal), 1e-9 * norm(normal));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int k = 0; k < 200; ++k) {
    const double x = place(random), y = place(random);
    int found = 0;
    for (const Triangle& t : triangles)
      found += holds({corner(polygon, t[0]), corner(polygon, t[1]), corner(polygon, t[2])}, x, y);
    EXPECT_EQ(found, holds(polygon, x, y) ? 1 : 0) << x << " " << y;
  }
}

/// Corners at random distances around the origin, with straight ones on the edges in between.
std::vector<Vec3d> random_polygon(unsigned seed, int corners, bool straight) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> distance(0.2, 1.4), part(0.1, 0.9);
  std::vector<Vec3d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, r = distance(random);
    const Vec3d next{r * std::cos(angle), r * std::sin(angle), 0};
    if (straight && i > 0)
      polygon.push_back(polygon.back() + part(random) * (next - polygon.back()));
    polygon.push_back(next);
  }
  return polygon;
}

TEST(Polygon, ConvexOnesBecomeAFan) {
  const std::vector<Triangle> fan = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(cut({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}), fan);
}

TEST(Polygon, LargeConvexOnesCrowdNoCorner) {
  std::vector<Vec3d> disc;
  for (int i = 0; i < 500; ++i)
    disc.push_back({std::cos(std::numbers::pi * i / 250), std::sin(std::numbers::pi * i / 250), 0});
  std::vector<int> faces(disc.size());
  double sum = 0;
  for (const Triangle& t : cut(disc)) {
    for (const Index c : t) ++faces[static_cast<std::size_t>(c)];
    sum += area(disc, t);
  }
  EXPECT_LT(*std::ranges::max_element(faces), 20);
  EXPECT_NEAR(sum, norm(area_vector(disc)), 1e-9);
}

TEST(Polygon, EveryPointIsCoveredOnce) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::vector<Vec3d> polygon =
        random_polygon(seed, 4 + static_cast<int>(seed) / 2, seed % 2 == 1);
    expect_covered_once(polygon, seed);
    std::ranges::reverse(polygon);
    expect_covered_once(polygon, seed);
  }
}

TEST(Polygon, StraightCornersOnEverySideOfATriangle) {
  // A fan around any corner of it has triangles without area.
  const std::vector<Vec3d> polygon = {{0, 0, 0},     {0.5, 0, 0}, {1, 0, 0},
                                      {0.5, 0.5, 0}, {0, 1, 0},   {0, 0.5, 0}};
  for (std::size_t first = 0; first < polygon.size(); ++first) {
    std::vector<Vec3d> turned(polygon.begin() + static_cast<std::ptrdiff_t>(first), polygon.end());
    turned.insert(turned.end(), polygon.begin(),
                  polygon.begin() + static_cast<std::ptrdiff_t>(first));
    expect_covered_once(turned, 1);
  }
}

TEST(Polygon, CornersThatRoundingMovedOffAStraightSide) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1e-9, 1e-9);
  for (int k = 0; k < 50; ++k) {
    std::vector<Vec3d> polygon;
    for (int side = 0; side < 4; ++side)
      for (int i = 0; i < 5; ++i) {
        const double s = i / 5.0 - 0.5;
        const Vec3d p = side == 0   ? Vec3d{s, -0.5, 0}
                        : side == 1 ? Vec3d{0.5, s, 0}
                        : side == 2 ? Vec3d{-s, 0.5, 0}
                                    : Vec3d{-0.5, -s, 0};
        polygon.push_back(p + Vec3d{noise(random), noise(random), 0});
      }
    for (const Triangle& t : cut(polygon)) EXPECT_GT(area(polygon, t), 1e-4);
  }
}

TEST(Polygon, StandsAnywhereInSpaceAndMayBeBent) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<Vec3d> flat = random_polygon(seed, 9, true);
    const Vec3d u = normalized(Vec3d{number(random), number(random), number(random)});
    const Vec3d v = normalized(cross(u, Vec3d{number(random), number(random), number(random)}));
    const Vec3d w = cross(u, v);
    const auto turn = [&](Vec3d p) { return p.x * u + p.y * v + p.z * w; };
    std::vector<Vec3d> placed, bent;
    for (const Vec3d p : flat) {
      placed.push_back(turn(1e-3 * p) + Vec3d{5, -3, 2});
      bent.push_back(turn({p.x, p.y, 0.05 * number(random)}));
    }
    double sum = 0;
    for (const Triangle& t : cut(placed)) sum += area(placed, t);
    EXPECT_NEAR(sum, 1e-6 * norm(area_vector(flat)), 1e-12);
    EXPECT_EQ(cut(bent).size(), bent.size() - 2);
  }
}

TEST(Polygon, AHoleThatABridgeOpens) {
  // The outer square runs to the left, the hole to the right; the bridge is passed twice.
  const std::vector<Vec3d> polygon = {
      {-1, -1, 0},     {1, -1, 0},     {1, 1, 0},     {-1, 1, 0},     {-1, -1, 0},
      {-0.5, -0.5, 0}, {-0.5, 0.5, 0}, {0.5, 0.5, 0}, {0.5, -0.5, 0}, {-0.5, -0.5, 0}};
  double sum = 0;
  for (const Triangle& t : cut(polygon)) sum += area(polygon, t);
  EXPECT_NEAR(sum, 3, 1e-9);
}

TEST(Polygon, TouchesItselfAtACorner) {
  // Two and three triangles around a common point, then a spike to the outside and to the inside.
  const std::vector<std::vector<Vec3d>> polygons = {
      {{0, 0, 0}, {2, 2, 0}, {4, 0, 0}, {4, 4, 0}, {2, 2, 0}, {0, 4, 0}},
      {{0, 0, 0},
       {1, -1, 0},
       {1, 1, 0},
       {0, 0, 0},
       {0.5, 2, 0},
       {-0.5, 2, 0},
       {0, 0, 0},
       {-1, 1, 0},
       {-1, -1, 0}},
      {{0, 0, 0}, {3, 0, 0}, {5, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}},
      {{0, 0, 0}, {3, 0, 0}, {3, 1.5, 0}, {1, 1.5, 0}, {3, 1.5, 0}, {3, 3, 0}, {0, 3, 0}}};
  for (const std::vector<Vec3d>& polygon : polygons) {
    double sum = 0;
    for (const Triangle& t : cut(polygon)) {
      EXPECT_GT(area(polygon, t), 1e-9);
      sum += area(polygon, t);
    }
    EXPECT_NEAR(sum, norm(area_vector(polygon)), 1e-9);
  }
}

/// Every pair of edges is compared.
bool slow_crossing(const std::vector<GridPoint>& x) {
  const auto sign = [](std::int64_t value) { return (value > 0) - (value < 0); };
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const GridPoint a = x[i], b = x[(i + 1) % n], c = x[j], d = x[(j + 1) % n];
      if (sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 &&
          sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0)
        return true;
    }
  return false;
}

TEST(Polygon, CrossingsAreFoundAsAmongAllPairsOfEdges) {
  // Rings of a few points on a coarse lattice touch, overlap and cross in every way.
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, 6), count(3, 9);
  int crossing = 0, free = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    std::vector<GridPoint> ring(static_cast<std::size_t>(count(random)));
    for (GridPoint& p : ring) p = {place(random), place(random)};
    const bool expected = slow_crossing(ring);
    ASSERT_EQ(crosses_itself(ring), expected) << "trial " << trial;
    ++(expected ? crossing : free);
  }
  EXPECT_GT(crossing, 1000);
  EXPECT_GT(free, 1000);
}

TEST(Polygon, WhatCannotBeCutIsRefused) {
  std::vector<Triangle> none;
  EXPECT_NE(cut_polygon(std::vector<Vec3d>{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}}, none)
                .find("does not cross itself"),
            std::string::npos);
  const std::vector<Vec3d> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  EXPECT_NE(cut_polygon(line, none).find("span an area"), std::string::npos);
  const std::vector<Vec3d> point(5, Vec3d{1, 2, 3});
  EXPECT_NE(cut_polygon(point, none).find("span an area"), std::string::npos);
  std::vector<Vec3d> star;
  for (int i = 0; i < 5; ++i)
    star.push_back({std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i), 0});
  EXPECT_NE(cut_polygon(star, none).find("does not cross itself"), std::string::npos);

  // Around a triangle twice, and around two triangles of which one lies in the other.
  for (const double inner : {1.0, 0.5}) {
    const std::vector<Vec3d> twice = {{0, 0, 0}, {4, 1, 0},         {1, 4, 0},
                                      {0, 0, 0}, {4 * inner, 1, 0}, {1, 4 * inner, 0}};
    EXPECT_NE(cut_polygon(twice, none).find("does not cross itself"), std::string::npos) << inner;
  }
  EXPECT_TRUE(none.empty());
}

TEST(Polygon, TheMostCornersAreCutAndOneMoreIsRefused) {
  // A comb: half of its corners turn right, so every triangle has to be tested against many.
  std::vector<Vec3d> comb;
  const int teeth = static_cast<int>(kMostCorners) / 2 - 1;
  for (int i = 0; i < teeth; ++i) {
    comb.push_back({1.0 * i, 0, 0});
    comb.push_back({i + 0.5, 1 + (i % 7) * 0.1, 0});
  }
  comb.push_back({1.0 * teeth, -1, 0});
  comb.push_back({0, -1, 0});
  std::ranges::reverse(comb);
  ASSERT_EQ(comb.size(), kMostCorners);
  double sum = 0;
  for (const Triangle& t : cut(comb)) sum += area(comb, t);
  EXPECT_NEAR(sum, norm(area_vector(comb)), 1e-6 * sum);
  comb.push_back({0, -0.5, 0});
  std::vector<Triangle> none;
  EXPECT_EQ(cut_polygon(comb, none), "at most " + std::to_string(kMostCorners) + " corners");
}

TEST(Polygon, TextureCoordinatesGoWithTheCorners) {
  const MeshFile file = parse_obj(
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\n"
      "vt 0 0\nvt 2 0\nvt 2 2\nvt 1 .5\nvt 0 2\nf 1/1 2/2 3/3 4/4 5/5\n",
      "a.obj");
  ASSERT_EQ(file.mesh.uv.size(), 3u);
  for (std::size_t f = 0; f < 3; ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d p = file.mesh.positions[static_cast<std::size_t>(file.mesh.faces[f][c])];
      EXPECT_EQ(file.mesh.uv[f][c].x, p.x);
      EXPECT_EQ(file.mesh.uv[f][c].y, p.y);
    }
}

TEST(Polygon, ObjAndPlyAreCutAlike) {
  const MeshFile obj = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5 6\nf 1 2 5\n", "a.obj");
  const MeshFile ply = parse_ply(
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 1 0 0 2 0 0 2 2 0 1 0.5 0 0 2 0\n6 0 1 2 3 4 5\n3 0 1 4\n",
      "a.ply");
  EXPECT_EQ(obj.mesh.faces.size(), 5u);
  EXPECT_EQ(obj.mesh.faces, ply.mesh.faces);
  EXPECT_EQ(obj.polygons, ply.polygons);
  EXPECT_TRUE(same_faces(obj, ply));
}

TEST(Polygon, ARestShapeTakesItsCutToTheStartState) {
  const std::string faces = "vt 0 0\nvt 1 0\nvt 2 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 1/1 2/2 3/3\n";
  MeshFile start = parse_obj("v 0 0 0\nv 1 .8 0\nv 2 0 0\nv 1 2 0\n" + faces, "start.obj");
  const MeshFile rest = parse_obj("v 0 0 0\nv 1 -1 0\nv 2 0 0\nv 1 .5 0\n" + faces, "rest.obj");
  ASSERT_NE(start.mesh.faces, rest.mesh.faces) << "the test needs two cuts";
  ASSERT_TRUE(same_faces(start, rest));
  cut_like(rest, start);
  EXPECT_EQ(start.mesh.faces, rest.mesh.faces);
  for (std::size_t f = 0; f < 3; ++f)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(start.mesh.uv[f][c].x, rest.mesh.uv[f][c].x);
  const MeshFile other =
      parse_obj("v 0 0 0\nv 1 -1 0\nv 2 0 0\nv 1 .5 0\nf 1 2 3 4\nf 1 3 2\n", "other.obj");
  EXPECT_FALSE(same_faces(start, other));
}

}  // namespace
}  // namespace icloth
