// The impact zones of every build behind one signature, so that one program can run them all.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/vec.h"
#include "sim/scene/parameters.h"

namespace icloth::testing {

/// The result of a solver for crossing sheets (tests/support/crossing.h).
struct ZoneOutcome {
  std::vector<Vec3d> x1;    ///< end of the step [m] (vertices)
  std::size_t impacts = 0;  ///< before
  double smallest_gap = 1;  ///< of them, after [impact_zones.offset]
  bool by_device = false;   ///< some zone was too large for a team
};

}  // namespace icloth::testing

// Three pairs of small sheets and one on a ball: many zones, a team solves each.
// Two large sheets: one zone, which the whole device solves.
namespace icloth::cpu32 {
testing::ZoneOutcome solve_small_zones(ZoneSolver solver);
testing::ZoneOutcome solve_large_zone(ZoneSolver solver);
}  // namespace icloth::cpu32
namespace icloth::cpu64 {
testing::ZoneOutcome solve_small_zones(ZoneSolver solver);
testing::ZoneOutcome solve_large_zone(ZoneSolver solver);
}  // namespace icloth::cpu64
namespace icloth::cuda32 {  // only where the program has CUDA
testing::ZoneOutcome solve_small_zones(ZoneSolver solver);
testing::ZoneOutcome solve_large_zone(ZoneSolver solver);
}  // namespace icloth::cuda32
