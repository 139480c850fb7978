// The coplanarity cubic: error bounds against a more precise evaluation, the bound of its first
// zero, and the arithmetic underneath.
#include "kernels/ccd/ccd_cubic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "kernels/ccd/ccd_first_zero.h"

namespace icloth {
namespace {

TEST(DoubleDouble, SumAndProductAreExact) {
  std::mt19937_64 generator(1);
  for (int k = 0; k < 10000; ++k) {
    const auto a = static_cast<std::int64_t>(generator() >> 12) - (std::int64_t{1} << 51);
    const auto b = static_cast<std::int64_t>(generator() >> (12 + k % 40));
    const auto da = static_cast<double>(a), db = static_cast<double>(b);
    const DoubleDouble p = exact_product(da, db), s = exact_sum(da, 0x1p-60 * db);
    EXPECT_TRUE(static_cast<__int128>(p.hi) + static_cast<__int128>(p.lo) ==
                static_cast<__int128>(a) * b);
    EXPECT_EQ(s.hi, da + 0x1p-60 * db);
    EXPECT_EQ((DoubleDouble(s.hi, s.lo) - DoubleDouble(da)).hi, 0x1p-60 * db);
  }
}

TEST(DoubleDouble, FieldLawsHoldWithinTheBound) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> gauss;
  const auto random = [&] { return exact_sum(gauss(generator), 0x1p-54 * gauss(generator)); };
  const auto near = [](DoubleDouble a, DoubleDouble b, double size) {
    return std::fabs((a - b).hi) <= 8 * kRoundoff<DoubleDouble>.hi * std::fabs(size);
  };
  for (int k = 0; k < 10000; ++k) {
    const DoubleDouble a = random(), b = random(), c = random();
    EXPECT_TRUE(near(a / b * b, a, a.hi));
    EXPECT_TRUE(near((a + b) - b, a, std::fabs(a.hi) + std::fabs(b.hi)));
    EXPECT_TRUE(
        near(a * (b + c), a * b + a * c, std::fabs(a.hi) * (std::fabs(b.hi) + std::fabs(c.hi))));
    EXPECT_TRUE((a < b) == (b > a) && (a < b) == ((a - b).hi < 0));
  }
}

template <class T>
VolumeVectors<T> random_vectors(std::mt19937& generator) {
  std::normal_distribution<T> gauss;
  std::uniform_int_distribution<int> exponent(-12, 12);
  const auto random = [&](T scale) {
    return Vec3<T>{scale * gauss(generator), scale * gauss(generator), scale * gauss(generator)};
  };
  const T b = std::ldexp(T(1), exponent(generator)), c = std::ldexp(T(1), exponent(generator)),
          p = std::ldexp(T(1), exponent(generator));
  VolumeVectors<T> v{random(b), random(c), random(p), random(b), random(c), random(p)};
  if (generator() % 4 == 0) v.p0 = v.b0 + v.c0;  // volumes near zero
  if (generator() % 4 == 0) v.p1 = v.b1;
  return v;
}

template <class T>
VolumeVectors<DoubleDouble> widened(const VolumeVectors<T>& v) {
  const auto wide = [](Vec3<T> a) { return convert<DoubleDouble>(a); };
  return {wide(v.b0), wide(v.c0), wide(v.p0), wide(v.b1), wide(v.c1), wide(v.p1)};
}

template <class T>
void check_bounds() {
  std::mt19937 generator(3);
  double worst_end = 0, worst_inner = 0;
  for (int k = 0; k < 50000; ++k) {
    const VolumeVectors<T> v = random_vectors<T>(generator);
    const VolumeCubic<T> f = volume_cubic(v);
    const VolumeCubic<DoubleDouble> g = volume_cubic(widened(v));
    const auto error = [](T x, DoubleDouble y) {
      return std::fabs((DoubleDouble(static_cast<double>(x)) - y).hi);
    };
    const auto end = static_cast<double>(f.error_ends), inner = static_cast<double>(f.error_inner);
    worst_end = std::max({worst_end, error(f.a, g.a) / end, error(f.b, g.b) / end});
    worst_inner =
        std::max({worst_inner, error(f.k1x3, g.k1x3) / inner, error(f.k2x3, g.k2x3) / inner});
  }
  EXPECT_LT(worst_end, 1);
  EXPECT_LT(worst_inner, 1);
  EXPECT_GT(worst_end, 0.005) << "the bound is far too wide, or the test too tame";
}

TEST(VolumeCubic, ErrorsStayWithinTheProvedBound) {
  check_bounds<float>();
  check_bounds<double>();
}

/// Bernstein coefficients of the given values, with a small error bound.
Bernstein3<double> cubic(double a, double b, double c, double d) {
  return Bernstein3<double>(VolumeCubic<double>{a, 3 * b, 3 * c, d, 0, 1e-15});
}

TEST(FirstZero, FindsRootsOfEveryKind) {
  const double root = std::cbrt(1 + std::sqrt(2)) - std::cbrt(std::sqrt(2) - 1);  // t³ + 3t = 2
  EXPECT_NEAR(first_zero_bound(cubic(1, 0.5, 0, -1), 0.0), root, 1e-13);
  EXPECT_EQ(first_zero_bound(cubic(1, 2, 3, 4), 0.0), kNever);
  EXPECT_EQ(first_zero_bound(cubic(-1, -2, -3, -4), 0.0), kNever);
  EXPECT_EQ(first_zero_bound(cubic(0, 1, 2, 3), 0.0), 0.0);
  EXPECT_EQ(first_zero_bound(cubic(0, 0, 0, 0), 0.25), 0.25);
  // (t − ½)²: a double root, and the same lifted and lowered.
  EXPECT_NEAR(first_zero_bound(cubic(0.25, -1. / 12, -1. / 12, 0.25), 0.0), 0.5, 1e-7);
  EXPECT_EQ(
      first_zero_bound(cubic(0.25 + 1e-9, -1. / 12 + 1e-9, -1. / 12 + 1e-9, 0.25 + 1e-9), 0.0),
      kNever);
  EXPECT_NEAR(first_zero_bound(cubic(0.24, -1. / 12 - 0.01, -1. / 12 - 0.01, 0.24), 0.0), 0.4,
              1e-9);
  // (t − ¼)(t − ½)(t − ¾): from each of the parts, and past the last.
  const Bernstein3<double> three = cubic(-3. / 32, 13. / 96, -13. / 96, 3. / 32);
  EXPECT_NEAR(first_zero_bound(three, 0.0), 0.25, 1e-12);
  EXPECT_NEAR(first_zero_bound(three, 0.3), 0.5, 1e-12);
  EXPECT_NEAR(first_zero_bound(three, 0.6), 0.75, 1e-12);
  EXPECT_EQ(first_zero_bound(three, 0.8), kNever);
}

TEST(FirstZero, LeavesNoRootBeforeIt) {
  std::mt19937 generator(5);
  std::normal_distribution<double> gauss;
  int found = 0;
  for (int k = 0; k < 20000; ++k) {
    const Bernstein3<double> f =
        cubic(gauss(generator), gauss(generator), gauss(generator), gauss(generator));
    const double start = k % 2 == 0 ? 0.0 : 0.37;
    const double bound = first_zero_bound(f, start);
    const double end = std::min(bound, 1.0);
    for (int i = 0; i < 64; ++i) {
      const double t = start + (end - start) * i / 64.0;
      EXPECT_GT(f(t) * f(start), 0) << "query " << k;
    }
    if (bound > 1) continue;
    ++found;
    EXPECT_LT(std::fabs(f(bound)), 1e-12) << "query " << k;
  }
  EXPECT_GT(found, 5000);
}

}  // namespace
}  // namespace icloth
