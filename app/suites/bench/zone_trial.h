// A comparison of the solvers of impact zones on a made-up zone of any size, away from any scene:
// it tells how near each comes to the optimum, and in what time.
#pragma once

#include "kernels/parallel/platform.h"
#include "sim/scene/parameters.h"

namespace icloth {

struct ZoneTrial {
  Index vertices = 0, constraints = 0, iterations = 0;
  double violation = 0;          ///< largest δ − n·g left [m]
  double complementarity = 0;    ///< see ZoneResult [m]
  double momentum_residual = 0;  ///< see ZoneResult
  double objective = 0;          ///< ½ Σ a |x − x*|² [m²]
  double milliseconds = 0;       ///< of the solve alone, best of several
};

/// Solves the zone of two square sheets of `side` × `side` vertices with edges of 5 mm, which have
/// gone 2 mm deep through each other with normals tilted at random. `solver` gets `iterations` at
/// most and the default parameters. In double precision it stops only where nothing moves any more,
/// so that the dual solver gives the optimum to compare with. Equal arguments give equal bits.
namespace cpu32 {
ZoneTrial solve_zone_trial(Index side, ZoneSolver solver, int iterations);
}
namespace cpu64 {
ZoneTrial solve_zone_trial(Index side, ZoneSolver solver, int iterations);
}

}  // namespace icloth
