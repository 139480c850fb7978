// The records of a collision: an impact of one round, and the constraint that is kept of it.
#pragma once

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// A pair that collides within the step.
struct Impact {
  std::uint64_t key;
  Stencil s;     ///< weights at the time of impact
  Vec3r normal;  ///< unit, at the time of impact, towards the side of the start
  Real offset;   ///< δ that the pair keeps [m]
  Real toi;      ///< fraction of the step, not later than the true one
};

/// A constraint of this step: n·g(x1) ≥ δ.
struct KeptImpact {
  std::uint64_t key;
  Stencil s;
  Vec3r normal;
  Real offset;      ///< δ of the pair [m]
  Real multiplier;  ///< λ of the last solve
  Index idle;       ///< rounds in a row in which it did nothing
  Index fresh;      ///< 1: collided in this round
};

}  // namespace icloth::ICLOTH_BUILD
