// The errors of a step in words and numbers, as the panels show them.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/parameters.h"
#include "sim/state/report.h"

namespace icloth {

struct Estimate {
  const char* name;
  std::string value;    ///< with its unit
  const char* meaning;  ///< one sentence
};

/// The estimates of one step with their meaning; none for a refused step.
std::vector<Estimate> estimates(const StepReport& report, const Parameters& parameters);

/// The estimates in one line of the side panel: "CG 4e-4 · momentum 1e-5 g · −0.3 mW · gap 12 %";
/// empty for a refused step.
std::string estimates_in_short(const StepReport& report, const Parameters& parameters);

/// The power that a step lost or made: "−0.3 mW", "+12 μW".
std::string signed_power(double watts);

}  // namespace icloth
