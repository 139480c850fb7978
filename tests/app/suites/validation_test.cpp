// The cases of `icloth bench validation` in their shortest form, and the references themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/references.h"
#include "app/suites/validation/strips.h"

namespace icloth::validation {
namespace {

std::vector<const Case*> all_cases() {
  std::vector<const Case*> list;
  for (const Case& test : cases()) list.push_back(&test);
  return list;
}

class Validation : public ::testing::TestWithParam<const Case*> {};

INSTANTIATE_TEST_SUITE_P(Cases, Validation, ::testing::ValuesIn(all_cases()),
                         [](const auto& listed) {
                           std::string name;
                           for (const char c : std::string_view(listed.param->name))
                             name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

TEST_P(Validation, IsWithinItsTargets) {
  Settings settings;
  settings.brief = true;
  ASSERT_TRUE(runs_on(*GetParam(), settings.build));
  const CaseResult result = run_case(*GetParam(), settings);
  EXPECT_FALSE(result.comparisons.empty());
  for (const std::string& failure : result.failures) ADD_FAILURE() << failure;
}

void miss(CaseRun& run) {
  run.compare("met", 2, 2.01, 0.01);
  run.compare("missed", 2, 2.03, 0.01);
  run.bound("no number", std::nan(""), 1);
}

/// The suite must be able to fail.
TEST(ValidationSuite, NamesWhatMisses) {
  const CaseResult result = run_case({"miss", "", false, miss}, {});
  ASSERT_EQ(result.comparisons.size(), 3u);
  ASSERT_EQ(result.failures.size(), 2u);
  EXPECT_NE(result.failures[0].find("missed"), std::string::npos);
  EXPECT_NE(result.failures[1].find("no number"), std::string::npos);
}

TEST(ValidationSuite, NamesAreDifferent) {
  std::vector<std::string> names;
  for (const Case& test : cases()) names.emplace_back(test.name);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(Strip, IsFlatAndWhole) {
  const Strip strip{0.3, 7, 3};
  const Cloth cloth = strip_cloth(
      strip,
      [](double u, double v) {
        return Vec3d{u, 0, -v};
      },
      plain_fabric(10, 0.2, 0.5, 1e-5));
  EXPECT_EQ(cloth.mesh.positions.size(), static_cast<std::size_t>(strip.vertices()));
  double area = 0;
  for (const auto& uv : cloth.mesh.uv) {
    const Vec2d a = uv[1] - uv[0], b = uv[2] - uv[0];
    EXPECT_GT(a.x * b.y - a.y * b.x, 0);
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  EXPECT_NEAR(area, strip.length * strip.width(), 1e-12);
  double mass = 0;
  for (const double m : lumped_mass(cloth)) mass += m;
  EXPECT_NEAR(mass, 0.5 * area, 1e-12);
  EXPECT_EQ(strip.row(1).size(), 5u);
  EXPECT_EQ(strip.row(7).back(), strip.vertices() - 1);
}

TEST(References, HeavyElasticaAgreesWithItsBoundaryValueProblem) {
  // Small loads: H/L = Γ/8. Large ones: all but a layer of size Γ^(-1/3) hangs.
  EXPECT_NEAR(heavy_elastica(1e-3).drop, 1e-3 / 8, 1e-8);
  EXPECT_GT(heavy_elastica(5000).drop, 0.99);
  // Solved as a boundary value problem, with tolerance 1e-9.
  const double known[][4] = {{1, .12347, .99125, 9.460},
                             {10, .70020, .65635, 60.312},
                             {100, .93752, .15922, 89.617},
                             {1000, .98114, .04599, 90.000}};
  for (const auto& [gamma, drop, reach, degrees] : known) {
    const HeavyElastica e = heavy_elastica(gamma);
    EXPECT_NEAR(e.drop, drop, 1e-5) << gamma;
    EXPECT_NEAR(e.reach, reach, 1e-5) << gamma;
    EXPECT_NEAR(e.tip_angle * 180 / std::numbers::pi, degrees, 1e-3) << gamma;
  }
}

TEST(References, CatenaryHasTheKnownSagParameterAndAngle) {
  EXPECT_NEAR(catenary(1.1).sag, 0.20030, 1e-5);
  EXPECT_NEAR(catenary(2).parameter, 0.22964, 1e-5);
  EXPECT_NEAR(catenary(1.5).end_angle * 180 / std::numbers::pi, 67.66, 5e-3);
}

TEST(References, HangingStripAndChainHaveTheKnownStretchAndModes) {
  EXPECT_NEAR(hanging_elongation(1, 0.187, 9.81, 50), 0.017717, 1e-6);
  // Linear theory: ρ g L²/2k.
  EXPECT_NEAR(hanging_elongation(1, 0.187, 9.81, 1e6) / (0.187 * 9.81 / 2e6), 1, 1e-5);
  EXPECT_NEAR(bessel_zero(1), 2.404826, 1e-6);
  EXPECT_NEAR(bessel_zero(2), 5.520078, 1e-6);
  EXPECT_NEAR(bessel_zero(3), 8.653728, 1e-6);
}

TEST(References, PressedElasticaAgreesWithItsBoundaryValueProblem) {
  // Solved as a boundary value problem: friction needed at a shortening, and the pressure.
  const double known[][2] = {{.01, .0448}, {.04, .0919}, {.1, .1528}, {.2, .2378}, {.3, .3265}};
  for (const auto& [shortening, friction] : known)
    EXPECT_NEAR(pressed_elastica(shortening).friction(), friction, 1e-4) << shortening;
  EXPECT_NEAR(pressed_elastica(.01).pressure, 20.27, 0.01);
  const auto tip = pressed_point(pressed_elastica(.1), 1);
  EXPECT_NEAR(tip[0], 0, 1e-6);
  EXPECT_NEAR(tip[1], 0.9, 1e-6);
}

TEST(References, ALightBeltAgreesWithEulerAndEytelwein) {
  // Light against its legs: Euler and Eytelwein.
  for (const double friction : {.1, .3, .5})
    EXPECT_NEAR(belt_leg(friction, 1, 1e-6), std::exp(friction * std::numbers::pi), 1e-4);
  EXPECT_NEAR(belt_friction(.1, belt_leg(.3, .1, .02), .02), .3, 1e-9);
}

}  // namespace
}  // namespace icloth::validation
