// The spring that draws the two vertices of a stitched pair together.
//
// Its energy is ½ k |x_a − x_b|² with k = μ (2/τ)², where μ = m_a m_b / (m_a + m_b) is the reduced
// mass of the pair and τ the time in which the pair would close if nothing else pulled at it. τ
// falls exponentially, so that the pull grows until the pair closes, whatever load the seam bears.
// The pull is at most F_max while the pair is open: k is lowered to F_max / |x_a − x_b| where it
// would exceed that. k itself grows to 2 F_max / ε at most, where ε is the distance at which the
// pair counts as closed; a pair that was closed once keeps this k and has no limit of force. The
// damping is critical, 2 √(k μ).
#pragma once

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

struct SeamLaw {
  Real slowest, fastest;  ///< τ at the start and after the ramp [s]
  Real ramp;              ///< time from the one to the other [s]
  Real max_force;         ///< F_max [N]
  Real closed;            ///< ε [m]
};

/// τ of a pair that has been closing for a time t ≥ 0 [s]. It falls by the same factor in equal
/// times, before the end of the ramp and after it.
ICLOTH_HD inline Real closing_time(const SeamLaw& law, Real t) {
  constexpr Real kMostRamps = 8;  // by then the stiffness has reached its limit
  return law.slowest * std::pow(law.fastest / law.slowest, std::fmin(t / law.ramp, kMostRamps));
}

/// Stiffness of a pair that was closed once [N/m].
ICLOTH_HD inline Real holding_stiffness(const SeamLaw& law) {
  return 2 * law.max_force / law.closed;
}

/// Stiffness k of an open pair with reduced mass μ [kg] and the distance r [m] [N/m].
ICLOTH_HD inline Real seam_stiffness(const SeamLaw& law, Real t, Real mass, Real distance) {
  const Real rate = 2 / closing_time(law, t);
  const Real k = std::fmin(mass * rate * rate, holding_stiffness(law));
  return k * distance > law.max_force ? law.max_force / distance : k;
}

/// Whether an open pair is pulled as strongly as it may be.
ICLOTH_HD inline bool pulls_fully(const SeamLaw& law, Real t, Real mass, Real distance) {
  return seam_stiffness(law, t, mass, distance) * distance >= Real(0.999) * law.max_force;
}

/// Energy of the spring between two points [J].
ICLOTH_HD inline Real seam_energy(Real stiffness, Vec3r a, Vec3r b) {
  return Real(0.5) * stiffness * norm2(a - b);
}

/// Force on a; that on b is opposite [N]. Its derivative by a is −k I, by b k I.
ICLOTH_HD inline Vec3r seam_force(Real stiffness, Vec3r a, Vec3r b) { return stiffness * (b - a); }

}  // namespace icloth::ICLOTH_BUILD
