// Solving impact zones: one team a zone, by the solver that was chosen.
#pragma once

#include "kernels/zones/zone_augmented_lagrangian.h"
#include "kernels/zones/zone_dual.h"
#include "kernels/zones/zone_linear.h"

namespace icloth::ICLOTH_BUILD {

/// Zones with more active vertices than this are solved by the whole device, one after the other.
inline constexpr Index kLargestTeamZone = 2048;

/// Solves every zone that is small enough for a team.
template <template <class> class Solver>
struct SolveZone {
  ZoneArrays z;
  ZoneSettings set;

  template <class Team>
  ICLOTH_HD void solve(Team& team, Index zone) const {
    Solver<Team> solver(team, z, set, zone);
    const int iterations = solver.solve();
    solver.finish(z, zone, iterations);
  }

  ICLOTH_HD void operator()(Team& team, Index zone) const {
    if (z.vertex_first[zone + 1] - z.vertex_first[zone] <= kLargestTeamZone) solve(team, zone);
  }
};

/// Solves one large zone with the whole device.
template <template <class> class Solver>
struct SolveLargeZone {
  SolveZone<Solver> solver;
  Index zone;
  ICLOTH_HD void operator()(DeviceTeam& team) const { solver.solve(team, zone); }
};

}  // namespace icloth::ICLOTH_BUILD
