// Compiled once a build.
#include "tests/sim/collision/zone_solvers.h"

#include <algorithm>

#include "tests/support/crossing.h"

namespace icloth::ICLOTH_BUILD {
namespace {

using testing::ZoneOutcome;

/// The outcome of a stage whose zones were solved.
ZoneOutcome outcome_of(const Stage& stage, const std::vector<Impact>& impacts) {
  ZoneOutcome outcome;
  const std::vector<Vec3r> x1 = stage.state.x1.download();
  for (const Vec3r& x : x1) outcome.x1.push_back(convert<double>(x));
  outcome.impacts = impacts.size();
  for (const Impact& impact : impacts)
    outcome.smallest_gap =
        std::min(outcome.smallest_gap, gap(impact, x1) / stage.parameters.impact_zones.offset);
  outcome.by_device = stage.report.largest_zone > kLargestTeamZone;
  return outcome;
}

}  // namespace

ZoneOutcome solve_small_zones(ZoneSolver solver) {
  Crossing crossing(true);
  crossing.stage.parameters.impact_zones.solver = solver;
  crossing.find();
  const std::vector<Impact> impacts = crossing.ccd.impacts().download();
  crossing.solve();
  return outcome_of(crossing.stage, impacts);
}

ZoneOutcome solve_large_zone(ZoneSolver solver) {
  CrossingSheets sheets(solver);
  sheets.solve();
  return outcome_of(sheets.stage, sheets.ccd.impacts().download());
}

}  // namespace icloth::ICLOTH_BUILD
