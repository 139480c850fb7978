// Comparisons on a simplified version of the paper's scene Sphere, as in its Fig. 13: what the
// parts of collision handling do there, each tried from the same states.
#pragma once

#include <functional>
#include <vector>

#include "app/suites/report/section.h"
#include "sim/simulator.h"

namespace icloth {

struct SphereSetup {
  Build build = Build::cpu32;
  double scale = 1;             ///< of its number of triangles
  std::function<void()> watch;  ///< called between steps; may throw
};

/// Sections of the report, and whether no state with penetrations was accepted.
struct SphereSections {
  std::vector<Section> sections;
  bool clean = true;
};

/// Fig. 13: impacts that are left without repulsion, without impact zones, and with both.
SphereSections measure_responses(const SphereSetup& setup);
/// Incremental detection, solvers of impact zones and broad phases on tangled states.
SphereSections measure_tangles(const SphereSetup& setup);
/// The solvers on made-up zones whose optimum is known.
SphereSections measure_optimum(const SphereSetup& setup);
/// One simulated second with each of several time steps.
SphereSections measure_time_steps(const SphereSetup& setup);

}  // namespace icloth
