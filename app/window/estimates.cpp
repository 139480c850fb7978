#include "app/window/estimates.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "sim/files/text.h"

namespace icloth {
namespace {

/// The size of gravity, |g| [m/s²].
double gravity_of(const Parameters& p) { return std::hypot(p.gravity.x, p.gravity.y, p.gravity.z); }

std::string momentum_in_g(const StepReport& report, const Parameters& p) {
  const double share = report.momentum_error / gravity_of(p);
  return brief_number(share < 1e-9 ? 0 : share);
}

std::string momentum_value(const StepReport& report, const Parameters& p) {
  const std::string value = brief_number(report.momentum_error) + " m/s²";
  if (!(gravity_of(p) > 0)) return value;
  return value + ", " + brief_number(100 * report.momentum_error / gravity_of(p)) + " % of g";
}

double power_of(const StepReport& report) {
  return report.dt > 0 ? report.energy_balance / report.dt : 0;
}

std::string power_value(double watts) {
  const std::string text = signed_power(watts);
  return text + (watts < 0 ? " (lost)" : watts > 0 ? " (made)" : "");
}

std::string percent(double share) { return brief_number(100 * share) + " %"; }

/// The depth of the closest pair inside the thickness h, 0 … 1.
double gap_violation(const StepReport& report, const Parameters& p) {
  return p.proximity.thickness > 0
             ? std::clamp(1 - report.min_gap / p.proximity.thickness, 0.0, 1.0)
             : 0;
}

double zone_violation(const StepReport& report, const Parameters& p) {
  return p.impact_zones.offset > 0 ? report.zone_violation / p.impact_zones.offset : 0;
}

}  // namespace

std::string signed_power(double watts) {
  constexpr struct {
    double size;
    const char* name;
  } kUnits[] = {{1, "W"}, {1e-3, "mW"}, {1e-6, "μW"}, {1e-9, "nW"}};
  const double size = std::fabs(watts);

  // Less than this is the rounding of any scene.
  if (size < 0.5e-9) return "0 W";

  const auto* unit = std::find_if(std::begin(kUnits), std::end(kUnits) - 1,
                                  [&](const auto& u) { return size >= u.size; });
  return (watts < 0 ? "−" : "+") + brief_number(size / unit->size) + " " + unit->name;
}

std::vector<Estimate> estimates(const StepReport& report, const Parameters& p) {
  if (!report.accepted) return {};

  // The sentences are shown as tooltips, for readers who do not know the name.
  return {
      {"CG residual", brief_number(report.cg_residual),
       "How much of the right-hand side the linear solves left over, at most."},
      {"momentum error", momentum_value(report, p),
       "Force per mass that a linear solve which stops early makes or loses: it pushes the whole "
       "cloth."},
      {"energy balance", power_value(power_of(report)),
       "Energy lost to damping, of the fabric and of the integrator, or made from nothing, as by "
       "measured fabrics while their stiffness changes with the strain."},
      {"gap violation", percent(gap_violation(report, p)) + " of the thickness",
       "How deep the closest pair was inside the thickness that the repulsion keeps, at the start "
       "of the step."},
      {"zone violation", percent(zone_violation(report, p)) + " of the offset",
       "How much the worst impact zone missed of the gap that it had to leave."},
  };
}

std::string estimates_in_short(const StepReport& report, const Parameters& p) {
  if (!report.accepted) return {};
  std::string text = "CG " + brief_number(report.cg_residual);
  if (gravity_of(p) > 0) text += " · momentum " + momentum_in_g(report, p) + " g";
  return text + " · " + signed_power(power_of(report)) + " · gap " +
         percent(gap_violation(report, p));
}

}  // namespace icloth
