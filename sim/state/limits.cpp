#include "sim/state/limits.h"

namespace icloth {

std::string_view parameter_of(Limit limit) {
  // A user raises a limit by its parameter, so it goes by the name that --set takes.
  switch (limit) {
    case Limit::substep_levels:
      return "step.max_substep_levels";
    case Limit::linearization_error:
      return "implicit.max_linearization_error";
    case Limit::newton_iterations:
      return "implicit.newton_iterations";
    case Limit::contact_passes:
      return "implicit.contact_passes";
    case Limit::cg_iterations:
      return "implicit.cg_max_iterations";
    case Limit::zone_iterations:
      return "impact_zones.iterations";
    case Limit::zone_rounds:
      return "impact_zones.max_rounds";
    case Limit::zone_correction:
      return "impact_zones.max_correction";
    case Limit::hand_speed:
      return "grab.max_speed";
    case Limit::hand_force:
      return "grab.max_force";
  }
  return "";
}

std::vector<std::string_view> names_of_limits(std::int64_t bits) {
  std::vector<std::string_view> names;
  for (int k = 0; k < kLimitCount; ++k)
    if (const auto limit = static_cast<Limit>(k); (bits & bit_of(limit)) != 0)
      names.push_back(parameter_of(limit));
  return names;
}

}  // namespace icloth
