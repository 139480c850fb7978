// The project's own exact triangle test: against integers, and against what find_intersections
// uses where the program has CGAL.
#include "sim/scene/exact_triangles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "sim/scene/intersections.h"
#include "tests/oracle/integer_triangles.h"

namespace icloth {
namespace {

/// Corners on a small lattice, many of them in one plane or on one line.
oracle::Corners lattice_corners(std::mt19937& random, int size) {
  oracle::Corners t;
  for (oracle::Point& p : t)
    for (std::int64_t& c : p) c = static_cast<std::int64_t>(random() % static_cast<unsigned>(size));
  return t;
}

/// The same on a lattice of another spacing and origin; exact for powers of two.
FaceCorners scaled(const oracle::Corners& t, double spacing, double origin) {
  FaceCorners out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = {origin + spacing * static_cast<double>(t[k][0]),
              origin + spacing * static_cast<double>(t[k][1]),
              origin + spacing * static_cast<double>(t[k][2])};
  return out;
}

TEST(ExactTriangles, AgreeWithIntegersAtEveryScale) {
  std::mt19937 random(1);
  int met = 0, apart = 0;
  for (int k = 0; k < 10'000; ++k) {
    const int size = k % 2 ? 4 : 9;
    const oracle::Corners s = lattice_corners(random, size), t = lattice_corners(random, size);
    const bool expected =
        !oracle::degenerate(s) && !oracle::degenerate(t) && oracle::intersect(s, t);
    (expected ? met : apart) += 1;
    for (const auto& [spacing, origin] :
         {std::pair{1.0, 0.0}, {0x1p-30, 1.0}, {0x1p-1060, 0.0}, {0x1p900, -0x1p902}}) {
      const FaceCorners a = scaled(s, spacing, origin), b = scaled(t, spacing, origin);
      ASSERT_EQ(triangles_meet(a, b), expected) << k << " " << spacing;
      ASSERT_EQ(triangles_meet(b, a), expected) << k << " " << spacing;
    }
  }
  EXPECT_GT(met, 2000);
  EXPECT_GT(apart, 2000);
}

TEST(ExactTriangles, SideOfPointsThatRoundingCannotTell) {
  // Numbers of 20 bits add up exactly: p, p + v and p + 2v are on one line.
  std::mt19937 random(2);
  const auto number = [&] {
    return std::ldexp(static_cast<double>(random() % (1u << 21)) - 0x1p20, -20);
  };
  const auto point = [&] {
    const double x = number(), y = number(), z = number();
    return Vec3d{x, y, z};
  };
  int uncertain = 0;
  for (int k = 0; k < 5000; ++k) {
    const Vec3d p = point(), v = point(), c = point() + Vec3d{0, 4, 0};
    const Vec3d middle = p + v, end = p + 2.0 * v;
    EXPECT_EQ(exact_side(p, end, c, middle), 0);
    Vec3d above = middle, below = middle;
    above.z = std::nextafter(middle.z, 10.0);
    below.z = std::nextafter(middle.z, -10.0);
    const int side = exact_side(p, end, c, above);
    EXPECT_EQ(side != 0, cross(end - p, c - p).z != 0);
    EXPECT_EQ(exact_side(p, end, c, below), -side);
    uncertain += certain_side(p, end, c, above) == 0;
    // An even permutation keeps the side, an odd one changes it.
    EXPECT_EQ(exact_side(end, c, p, above), side);
    EXPECT_EQ(exact_side(end, p, c, above), -side);
    EXPECT_EQ(exact_side(above, c, end, p), side);
  }
  EXPECT_GT(uncertain, 1000);
}

TEST(ExactTriangles, TouchingCountsOneRoundingApartDoesNot) {
  const FaceCorners ground{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  for (const double height :
       {0.0, std::numeric_limits<double>::denorm_min(), 1e-300, 1e-17, -1e-17}) {
    const FaceCorners tip{{{0.25, 0.25, height}, {0.25, 0.25, 1}, {0.5, 0.25, 1}}};
    EXPECT_EQ(triangles_meet(ground, tip), height <= 0) << height;
  }
  const FaceCorners beside{{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}};  // shares a point
  EXPECT_TRUE(triangles_meet(ground, beside));
  const FaceCorners inside{{{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}}};
  EXPECT_TRUE(triangles_meet(ground, inside) && triangles_meet(inside, ground));
  const FaceCorners line{{{-1, 0.2, 0}, {0, 0.2, 0}, {1, 0.2, 0}}};
  EXPECT_FALSE(triangles_meet(ground, line)) << "no area";
}

/// Triangles whose corners lie nearly in common planes, a few roundings off.
TEST(ExactTriangles, AgreeWithFindIntersectionsNearPlanes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] {
    const double x = uniform(random), y = uniform(random);
    double z = 0.3 * x - 0.7 * y + 0.1;
    for (unsigned k = random() % 4; k > 0; --k) z = std::nextafter(z, random() % 2 ? 2.0 : -2.0);
    return Vec3d{x, y, z};
  };
  const std::vector<Triangle> faces{{0, 1, 2}, {3, 4, 5}};
  int met = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::vector<Vec3d> x(6);
    for (Vec3d& p : x) p = point();
    if (k % 3 == 0) x[3] = x[0];  // touch in a corner without sharing it
    const bool expected = !find_intersections(x, faces, {}).empty();
    ASSERT_EQ(triangles_meet({x[0], x[1], x[2]}, {x[3], x[4], x[5]}), expected) << k;
    met += expected;
  }
  EXPECT_GT(met, 5000);
}

}  // namespace
}  // namespace icloth
