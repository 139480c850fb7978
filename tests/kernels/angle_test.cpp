// The project's own atan2 in single precision.
#include "kernels/angle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace icloth {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Difference in units in the last place of the true value.
double ulps(float y, float x) {
  const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
  const auto rounded = static_cast<float>(std::fabs(exact));
  const double unit =
      static_cast<double>(std::nextafter(rounded, 4.0f)) - static_cast<double>(rounded);
  return std::fabs(static_cast<double>(angle_of(y, x)) - exact) / unit;
}

TEST(Angle, IsThatOfTheLibraryWithinThreeUnits) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1), exponent(-12, 12);
  double worst = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    const float scale = std::pow(10.0f, exponent(random));
    worst = std::max(worst, ulps(uniform(random) * scale, uniform(random)));
  }
  for (int k = -100'000; k <= 100'000; ++k)
    worst = std::max(worst, ulps(static_cast<float>(std::sin(1e-5 * k * kPi)),
                                 static_cast<float>(std::cos(1e-5 * k * kPi))));
  EXPECT_LT(worst, 3);
}

TEST(Angle, IsExactOnAxesAndDiagonals) {
  EXPECT_EQ(angle_of(0.0f, 0.0f), 0);
  EXPECT_EQ(angle_of(0.0f, 2.0f), 0);
  for (int k = -3; k <= 4; ++k) {
    const double a = 0.25 * k * kPi;
    const auto y = static_cast<float>(std::lround(std::sin(a) * 1.2)),
               x = static_cast<float>(std::lround(std::cos(a) * 1.2));
    EXPECT_FLOAT_EQ(angle_of(y, x), static_cast<float>(a)) << k;
  }
}

TEST(Angle, IsOddInYAndGrowsMonotonically) {
  float last = -4;
  for (int k = -999; k <= 999; ++k) {
    const auto y = static_cast<float>(std::sin(1e-3 * k * kPi)),
               x = static_cast<float>(std::cos(1e-3 * k * kPi));
    const float angle = angle_of(y, x);
    EXPECT_GT(angle, last);
    EXPECT_EQ(angle_of(-y, x), -angle);
    last = angle;
  }
}

TEST(Angle, TakesTinyNumbersAndKeepsNaN) {
  const float tiny = std::numeric_limits<float>::denorm_min(),
              nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FLOAT_EQ(angle_of(tiny, tiny), static_cast<float>(kPi / 4));
  EXPECT_EQ(angle_of(tiny, 1.0f), tiny);
  EXPECT_FLOAT_EQ(angle_of(1.0f, -tiny), static_cast<float>(kPi / 2));
  EXPECT_TRUE(std::isnan(angle_of(nan, 1.0f)) && std::isnan(angle_of(1.0f, nan)));
}

TEST(Angle, InDoublePrecisionIsThatOfTheLibrary) {
  EXPECT_EQ(angle_of(0.3, -0.7), std::atan2(0.3, -0.7));
}

}  // namespace
}  // namespace icloth
