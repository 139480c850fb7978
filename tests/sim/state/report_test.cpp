#include "sim/state/report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

using namespace icloth;

namespace {

const ReportColumn& column(std::string_view name) {
  for (const ReportColumn& c : report_columns())
    if (c.name == name) return c;
  ADD_FAILURE() << "no column " << name;
  return report_columns().front();
}

}  // namespace

TEST(Report, ColumnsStandInTheOrderThatFilesPromise) {
  std::string names;
  for (const ReportColumn& c : report_columns()) names += std::string(c.name) + " ";
  EXPECT_EQ(names,
            "step time dt substeps retries "
            "ms_total ms_proximity ms_implicit ms_broad_phase ms_ccd ms_impact_zones ms_other "
            "proximity_pairs candidate_pairs elementary_tests impacts_first impacts_left "
            "rounds zones largest_zone zone_iterations dynamic_faces static_faces "
            "newton_iterations linear_solves cg_iterations cg_residual "
            "kinetic_energy elastic_energy gravity_energy max_strain max_speed min_gap "
            "state_hash "
            "zone_violation zone_complementarity zone_momentum_residual box_tests "
            "momentum_error energy_balance pinched limits open_pairs stuck_pairs seam_gap "
            "late_contacts ");
}

TEST(Report, EveryColumnReadsItsOwnMember) {
  StepReport report;
  for (const ReportColumn& c : report_columns()) {
    const std::string before = report_value(report, c);
    std::visit([&](auto member) { report.*member = 77; }, c.member);
    EXPECT_NE(report_value(report, c), before) << c.name;
  }
  std::set<std::string> values;
  for (const ReportColumn& c : report_columns()) values.insert(report_value(report, c));
  EXPECT_EQ(values, (std::set<std::string>{"77", "000000000000004d"}));
}

TEST(Report, ValuesKeepTheirDigits) {
  StepReport report;
  report.step = 9007199254740993;
  report.time = 0.1 / 3;
  report.state_hash = 0x00ab;
  EXPECT_EQ(report_value(report, column("step")), "9007199254740993");
  EXPECT_EQ(report_value(report, column("state_hash")), "00000000000000ab");
  EXPECT_NEAR(std::atof(report_value(report, column("time")).c_str()), 0.1 / 3, 1e-10);
}
