#include "sim/state/report.h"

#include <cinttypes>
#include <cstdio>

namespace icloth {
namespace {

using R = StepReport;

constexpr ReportColumn kColumns[] = {
    {"step", &R::step},
    {"time", &R::time},
    {"dt", &R::dt},
    {"substeps", &R::substeps},
    {"retries", &R::retries},
    {"ms_total", &R::ms_total},
    {"ms_proximity", &R::ms_proximity},
    {"ms_implicit", &R::ms_implicit},
    {"ms_broad_phase", &R::ms_broad_phase},
    {"ms_ccd", &R::ms_ccd},
    {"ms_impact_zones", &R::ms_impact_zones},
    {"ms_other", &R::ms_other},
    {"proximity_pairs", &R::proximity_pairs},
    {"candidate_pairs", &R::candidate_pairs},
    {"elementary_tests", &R::elementary_tests},
    {"impacts_first", &R::impacts_first},
    {"impacts_left", &R::impacts_left},
    {"rounds", &R::rounds},
    {"zones", &R::zones},
    {"largest_zone", &R::largest_zone},
    {"zone_iterations", &R::zone_iterations},
    {"dynamic_faces", &R::dynamic_faces},
    {"static_faces", &R::static_faces},
    {"newton_iterations", &R::newton_iterations},
    {"linear_solves", &R::linear_solves},
    {"cg_iterations", &R::cg_iterations},
    {"cg_residual", &R::cg_residual},
    {"kinetic_energy", &R::kinetic_energy},
    {"elastic_energy", &R::elastic_energy},
    {"gravity_energy", &R::gravity_energy},
    {"max_strain", &R::max_strain},
    {"max_speed", &R::max_speed},
    {"min_gap", &R::min_gap},
    {"state_hash", &R::state_hash},
    {"zone_violation", &R::zone_violation},
    {"zone_complementarity", &R::zone_complementarity},
    {"zone_momentum_residual", &R::zone_momentum_residual},
    {"box_tests", &R::box_tests},
    {"momentum_error", &R::momentum_error},
    {"energy_balance", &R::energy_balance},
    {"pinched", &R::pinched},
    {"limits", &R::limits},
    {"open_pairs", &R::open_pairs},
    {"stuck_pairs", &R::stuck_pairs},
    {"seam_gap", &R::seam_gap},
    {"late_contacts", &R::late_contacts},
};

}  // namespace

std::span<const ReportColumn> report_columns() { return kColumns; }

std::string report_value(const StepReport& report, const ReportColumn& column) {
  char text[40] = "";
  if (const auto* real = std::get_if<double R::*>(&column.member))
    std::snprintf(text, sizeof text, "%.9g", report.**real);
  if (const auto* count = std::get_if<std::int64_t R::*>(&column.member))
    std::snprintf(text, sizeof text, "%" PRId64, report.**count);
  if (const auto* hash = std::get_if<std::uint64_t R::*>(&column.member))
    std::snprintf(text, sizeof text, "%016" PRIx64, report.**hash);
  return text;
}

}  // namespace icloth
