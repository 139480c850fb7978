// The spring that draws the two vertices of a stitched pair together.
//
// Its energy is ½ k |x_a − x_b|² with k = μ (2/τ)², where μ = m_a m_b / (m_a + m_b) is the reduced
// mass of the pair and τ the time in which the pair would close by itself. τ falls from a slow
// start to a fast end. The pull is at most F_max: k is lowered to F_max / |x_a − x_b| where it
// would exceed that. The damping is critical, 2 √(k μ).
#pragma once

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

struct SeamLaw {
  Real slowest, fastest;  ///< τ at the start and at the end [s]
  Real ramp;              ///< time from the one to the other [s]
  Real max_force;         ///< F_max [N]
};

/// τ of a pair that has been closing for a time t ≥ 0 [s]. It falls by the same factor in equal
/// times, so that the pull grows gently at first.
ICLOTH_HD inline Real closing_time(const SeamLaw& law, Real t) {
  if (!(t < law.ramp)) return law.fastest;
  return law.slowest * std::pow(law.fastest / law.slowest, t / law.ramp);
}

/// Stiffness k of a pair with reduced mass μ [kg] and the distance r [m] [N/m].
ICLOTH_HD inline Real seam_stiffness(const SeamLaw& law, Real t, Real mass, Real distance) {
  const Real rate = 2 / closing_time(law, t);
  const Real k = mass * rate * rate;
  return k * distance > law.max_force ? law.max_force / distance : k;
}

/// Energy of the spring between two points [J].
ICLOTH_HD inline Real seam_energy(Real stiffness, Vec3r a, Vec3r b) {
  return Real(0.5) * stiffness * norm2(a - b);
}

/// Force on a; that on b is opposite [N]. Its derivative by a is −k I, by b k I.
ICLOTH_HD inline Vec3r seam_force(Real stiffness, Vec3r a, Vec3r b) { return stiffness * (b - a); }

}  // namespace icloth::ICLOTH_BUILD
