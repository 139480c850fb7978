// The errors of a step as the panels write them.
#include <gtest/gtest.h>

#include "app/window/estimates.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

StepReport some_report() {
  StepReport r;
  r.dt = 0.01;
  r.cg_residual = 4.2e-4;
  r.momentum_error = 9.81e-5;
  r.energy_balance = -3e-6;
  r.min_gap = 0.88e-3;
  r.zone_violation = 1e-6;
  return r;
}

Parameters some_parameters() {
  Parameters p;
  p.gravity.x = p.gravity.z = 0, p.gravity.y = -9.81;
  p.proximity.thickness = 1e-3;
  p.impact_zones.offset = 1e-4;
  return p;
}

std::string value_of(const std::vector<Estimate>& list, std::string_view name) {
  for (const Estimate& e : list)
    if (e.name == name) return e.value;
  return "no " + std::string(name);
}

TEST(EstimateText, NumbersAreShort) {
  EXPECT_EQ(brief_number(0), "0");
  EXPECT_EQ(brief_number(4.2e-4), "4e-4");
  EXPECT_EQ(brief_number(1e-10), "1e-10");
  EXPECT_EQ(brief_number(0.0123), "0.012");
  EXPECT_EQ(brief_number(3.14159), "3.1");
  EXPECT_EQ(brief_number(9.96), "10");
  EXPECT_EQ(brief_number(123.4), "123");
  EXPECT_EQ(brief_number(2.1e7), "2e7");
  EXPECT_EQ(brief_number(-0.5), "-0.5");
}

TEST(EstimateText, PowersHaveASignAndAUnit) {
  EXPECT_EQ(signed_power(0), "0 W");
  EXPECT_EQ(signed_power(-1e-12), "0 W");
  EXPECT_EQ(signed_power(-3e-4), "−300 μW");
  EXPECT_EQ(signed_power(2.5e-3), "+2.5 mW");
  EXPECT_EQ(signed_power(-12), "−12 W");
  EXPECT_EQ(signed_power(7e-10), "+0.7 nW");
}

TEST(EstimateText, SaysWhatAStepGotWrong) {
  const auto list = estimates(some_report(), some_parameters());
  EXPECT_EQ(value_of(list, "CG residual"), "4e-4");
  EXPECT_EQ(value_of(list, "momentum error"), "1e-4 m/s², 1e-3 % of g");
  EXPECT_EQ(value_of(list, "energy balance"), "−300 μW (lost)");
  EXPECT_EQ(value_of(list, "gap violation"), "12 % of the thickness");
  EXPECT_EQ(value_of(list, "zone violation"), "1 % of the offset");
  EXPECT_EQ(estimates_in_short(some_report(), some_parameters()),
            "CG 4e-4 · momentum 1e-5 g · −300 μW · gap 12 %");
}

TEST(EstimateText, WithoutGravityThereIsNothingToCompareWith) {
  Parameters p = some_parameters();
  p.gravity.y = 0;
  EXPECT_EQ(value_of(estimates(some_report(), p), "momentum error"), "1e-4 m/s²");
  EXPECT_EQ(estimates_in_short(some_report(), p), "CG 4e-4 · −300 μW · gap 12 %");
}

TEST(EstimateText, EnergyFromNothingIsCalledMadeAndRoundingZero) {
  StepReport r = some_report();
  r.energy_balance = 4e-5;
  EXPECT_EQ(value_of(estimates(r, some_parameters()), "energy balance"), "+4 mW (made)");
  r.momentum_error = 1e-12;
  EXPECT_EQ(estimates_in_short(r, some_parameters()), "CG 4e-4 · momentum 0 g · +4 mW · gap 12 %");
}

TEST(EstimateText, ARefusedStepHasNone) {
  StepReport r = some_report();
  r.accepted = false;
  EXPECT_TRUE(estimates(r, some_parameters()).empty());
  EXPECT_EQ(estimates_in_short(r, some_parameters()), "");
}

}  // namespace
}  // namespace icloth
