// Closest points against brute force: no sampled pair of points is closer, and the reported pair
// has the reported distance.
#include "kernels/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace icloth {
namespace {

Vec3d random_point(std::mt19937& generator, double scale) {
  std::uniform_real_distribution<double> u(-scale, scale);
  return {u(generator), u(generator), u(generator)};
}

template <class T>
Vec3<T> point_of(const TrianglePoint<T>& x, Vec3<T> a, Vec3<T> b, Vec3<T> c) {
  return x.w[0] * a + x.w[1] * b + x.w[2] * c;
}

/// Smallest squared distance over a grid of the triangle.
double sampled_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  double best = INFINITY;
  const int n = 40;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const double v = static_cast<double>(i) / n, w = static_cast<double>(j) / n;
      best = std::min(best, norm2((1 - v - w) * a + v * b + w * c - p));
    }
  }
  return best;
}

double sampled_segments(Vec3d a0, Vec3d a1, Vec3d b0, Vec3d b1) {
  double best = INFINITY;
  const int n = 40;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double s = static_cast<double>(i) / n, t = static_cast<double>(j) / n;
      best = std::min(best, norm2((1 - s) * a0 + s * a1 - (1 - t) * b0 - t * b1));
    }
  }
  return best;
}

void check_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const TrianglePoint<double> x = closest_point_triangle(p, a, b, c);
  const double size = std::max({norm(a - p), norm(b - p), norm(c - p)});
  EXPECT_NEAR(x.w[0] + x.w[1] + x.w[2], 1, 1e-14);
  for (double w : x.w) EXPECT_GE(w, 0);
  EXPECT_NEAR(norm(point_of(x, a, b, c) - p), std::sqrt(x.distance2), 1e-12 * size);
  const double sampled = std::sqrt(sampled_triangle(p, a, b, c));
  EXPECT_LE(std::sqrt(x.distance2), sampled + 1e-12 * size);
  // The grid lies at most half a cell of the longest edge away.
  EXPECT_GE(std::sqrt(x.distance2),
            sampled - std::max({norm(b - a), norm(c - a), norm(c - b)}) / 40);

  // The short search gives the same answer where that is inside.
  const auto inside = closest_point_triangle(p, a, b, c, ClosestPoints::interior_only);
  EXPECT_EQ(inside.interior, x.interior);
  if (x.interior) {
    EXPECT_EQ(inside.distance2, x.distance2);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(inside.w[k], x.w[k]);
  }
}

void check_segments(Vec3d a0, Vec3d a1, Vec3d b0, Vec3d b1) {
  const SegmentPoints<double> x = closest_points_segments(a0, a1, b0, b1);
  const double size = norm(a1 - a0) + norm(b1 - b0) + norm(b0 - a0);
  EXPECT_TRUE(x.s >= 0 && x.s <= 1 && x.t >= 0 && x.t <= 1);
  const Vec3d gap = (1 - x.t) * b0 + x.t * b1 - (1 - x.s) * a0 - x.s * a1;
  EXPECT_NEAR(norm(gap), std::sqrt(x.distance2), 1e-12 * size);
  const double sampled = std::sqrt(sampled_segments(a0, a1, b0, b1));
  EXPECT_LE(std::sqrt(x.distance2), sampled + 1e-12 * size);
  EXPECT_GE(std::sqrt(x.distance2), sampled - (norm(a1 - a0) + norm(b1 - b0)) / 80);
  EXPECT_EQ(x.interior, x.s > 0 && x.s < 1 && x.t > 0 && x.t < 1);

  // The short search gives the same answer where that is inside.
  const auto inside = closest_points_segments(a0, a1, b0, b1, ClosestPoints::interior_only);
  EXPECT_EQ(inside.interior, x.interior);
  if (x.interior) {
    EXPECT_EQ(inside.distance2, x.distance2);
    EXPECT_EQ(inside.s, x.s);
    EXPECT_EQ(inside.t, x.t);
  }
}

TEST(ClosestPointTriangle, LiesOnTheFaceAnEdgeOrAVertex) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  const auto face = closest_point_triangle(Vec3d{0.25, 0.25, 2}, a, b, c);
  EXPECT_TRUE(face.interior);
  EXPECT_DOUBLE_EQ(face.distance2, 4);
  EXPECT_DOUBLE_EQ(face.w[0], 0.5);
  const auto edge = closest_point_triangle(Vec3d{0.5, -1, 0}, a, b, c);
  EXPECT_FALSE(edge.interior);
  EXPECT_DOUBLE_EQ(edge.distance2, 1);
  EXPECT_DOUBLE_EQ(edge.w[1], 0.5);
  const auto corner = closest_point_triangle(Vec3d{-3, -4, 0}, a, b, c);
  EXPECT_FALSE(corner.interior);
  EXPECT_DOUBLE_EQ(corner.distance2, 25);
  EXPECT_EQ(corner.w[0], 1);
  EXPECT_FALSE(closest_point_triangle(Vec3d{0.5, 0, 1}, a, b, c).interior) << "above an edge";
}

TEST(ClosestPointTriangle, NoSampleIsNearer) {
  std::mt19937 generator(1);
  for (int k = 0; k < 1000; ++k) {
    const Vec3d a = random_point(generator, 1), b = random_point(generator, 1),
                c = random_point(generator, 1);
    check_triangle(random_point(generator, 2), a, b, c);
    // Needle, almost a segment, and a point.
    const Vec3d on_edge = 0.3 * a + 0.7 * b;
    check_triangle(random_point(generator, 2), a, b, on_edge + random_point(generator, 1e-9));
    check_triangle(random_point(generator, 2), a, b, on_edge);
    check_triangle(random_point(generator, 2), a, a, a);
  }
}

TEST(ClosestPointsSegments, AreFoundOnCrossingAndDistantSegments) {
  const auto crossing =
      closest_points_segments(Vec3d{-1, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, -1, 3}, Vec3d{0, 3, 3});
  EXPECT_TRUE(crossing.interior);
  EXPECT_DOUBLE_EQ(crossing.s, 0.5);
  EXPECT_DOUBLE_EQ(crossing.t, 0.25);
  EXPECT_DOUBLE_EQ(crossing.distance2, 9);
  const auto ends =
      closest_points_segments(Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{4, 4, 0}, Vec3d{5, 9, 0});
  EXPECT_FALSE(ends.interior);
  EXPECT_EQ(ends.s, 1);
  EXPECT_EQ(ends.t, 0);
  EXPECT_DOUBLE_EQ(ends.distance2, 25);
}

TEST(ClosestPointsSegments, NoSamplesAreNearer) {
  std::mt19937 generator(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3d a0 = random_point(generator, 1), a1 = random_point(generator, 1),
                b0 = random_point(generator, 1), b1 = random_point(generator, 1);
    check_segments(a0, a1, b0, b1);
    const Vec3d shift = random_point(generator, 1);
    check_segments(a0, a1, a0 + shift, a1 + shift);  // parallel
    check_segments(a0, a1, a1 + shift, a0 + shift);  // and reversed
    check_segments(a0, a1, a0 + shift, a1 + shift + random_point(generator, 1e-9));
    check_segments(a0, a1, 0.5 * (a0 + a1), 2.0 * a1 - a0);  // collinear, overlapping
    check_segments(a0, a0, b0, b1);                          // a point
    check_segments(a0, a0, b0, b0);
  }
}

TEST(ClosestPoints, SinglePrecisionAgreesWithDouble) {
  std::mt19937 generator(3);
  for (int k = 0; k < 2000; ++k) {
    Vec3d x[4];
    for (Vec3d& p : x) p = convert<double>(convert<float>(random_point(generator, 1)));
    Vec3f y[4];
    for (int i = 0; i < 4; ++i) y[i] = convert<float>(x[i]);
    const double vf = closest_point_triangle(x[0], x[1], x[2], x[3]).distance2;
    const double ee = closest_points_segments(x[0], x[1], x[2], x[3]).distance2;
    const float vf32 = closest_point_triangle(y[0], y[1], y[2], y[3]).distance2;
    const float ee32 = closest_points_segments(y[0], y[1], y[2], y[3]).distance2;
    EXPECT_NEAR(std::sqrt(vf), std::sqrt(vf32), 3e-5);
    EXPECT_NEAR(std::sqrt(ee), std::sqrt(ee32), 3e-5);
  }
}

}  // namespace
}  // namespace icloth
