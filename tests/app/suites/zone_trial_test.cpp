// The solvers of impact zones on a made-up zone, compared with the optimum in double precision.
#include "app/suites/bench/zone_trial.h"

#include <gtest/gtest.h>

namespace icloth {
namespace {

/// Two sheets pass through each other: the dual solver ends at the optimum, and the paper's comes
/// near it in its 100 iterations.
TEST(ZoneTrial, DualSolverFindsTheOptimum) {
  for (const Index side : {5, 15, 50}) {
    const double optimum = cpu64::solve_zone_trial(side, ZoneSolver::dual, 10000).objective;
    const ZoneTrial dual = cpu32::solve_zone_trial(side, ZoneSolver::dual, 100);
    const ZoneTrial paper = cpu32::solve_zone_trial(side, ZoneSolver::augmented_lagrangian, 100);

    // Both keep the layers apart and balance the momentum; only the dual one has converged.
    const Parameters defaults;
    EXPECT_LE(dual.violation, 0.2 * defaults.impact_zones.offset);
    EXPECT_LT(paper.violation, defaults.impact_zones.offset)
        << "no penetration, but not converged either";
    for (const ZoneTrial& trial : {dual, paper}) EXPECT_LT(trial.momentum_residual, 1e-4);
    EXPECT_LE(dual.complementarity, 0.2 * defaults.impact_zones.offset);

    // The objective tells how far each moves the vertices beyond what is needed.
    EXPECT_NEAR(dual.objective, optimum, 0.01 * optimum) << side;
    EXPECT_GT(paper.objective, 0.99 * optimum);
    EXPECT_LT(paper.objective, 1.5 * optimum);
    EXPECT_LT(dual.iterations, 20);
  }
}

}  // namespace
}  // namespace icloth
