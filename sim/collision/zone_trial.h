// The solvers of impact zones on a made-up zone of any size, away from any scene: how fast they
// get how near to the optimum.
#pragma once

#include "kernels/parallel/platform.h"
#include "sim/scene/parameters.h"

namespace icloth {

struct ZoneTrial {
  Index vertices = 0, constraints = 0, iterations = 0;
  double violation = 0;        ///< largest δ − n·g left [m]
  double complementarity = 0;  ///< see ZoneResult [m]
  double momentum = 0;         ///< likewise, relative
  double objective = 0;        ///< ½ Σ a |x − x*|² [m²]
  double milliseconds = 0;     ///< of the solve alone, best of several
};

/// Two square sheets of `side` × `side` vertices, 5 mm apart in the plane, that have gone 2 mm deep
/// through each other with normals tilted at random. `solver` gets `iterations` at most and the
/// default parameters; in double precision it stops only where nothing moves any more, so that the
/// dual one gives the optimum to compare with. Deterministic.
namespace cpu32 {
ZoneTrial solve_zone_trial(Index side, ZoneSolver solver, int iterations);
}
namespace cpu64 {
ZoneTrial solve_zone_trial(Index side, ZoneSolver solver, int iterations);
}

}  // namespace icloth
