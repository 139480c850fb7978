// Repulsion and friction of one VF or EE pair in proximity, linear in the velocities of the step.
//
// Repulsion (paper Section 2.5): quadratic in the predicted gap; a pair whose gap will be below the
// thickness h pushes with k a (h − gap), a the area of its features. Friction: Coulomb's law as the
// drag coefficient s for which the *implicit* result is Coulomb's (not μ N/|v|, which halves it).
#pragma once

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// A pair in proximity, as found at the start of the step.
struct Contact {
  std::uint64_t key;
  Stencil s;      ///< gap vector g(x0) = Σ w x0
  Vec3r normal;   ///< unit, along g
  Real gap;       ///< |g| [m]
  Real area;      ///< of the features [m²]
  Real friction;  ///< Coulomb coefficient
};

/// What a contact adds to the system A Δv = b: H [kg] on the left, impulse [N·s] on the right.
struct ContactTerm {
  Real h[6];      ///< symmetric: xx xy xz yy yz zz
  Vec3r impulse;  ///< Σ over corners with their weights
};

ICLOTH_HD inline Vec3r multiply(const ContactTerm& t, Vec3r v) {
  return {t.h[0] * v.x + t.h[1] * v.y + t.h[2] * v.z, t.h[1] * v.x + t.h[3] * v.y + t.h[4] * v.z,
          t.h[2] * v.x + t.h[4] * v.y + t.h[5] * v.z};
}

/// relative: Σ w v at the start [m/s]; drift: what gravity adds to it in the step [m/s];
/// inverse_mass: Σ w²/m of the free corners [1/kg].
ICLOTH_HD inline ContactTerm contact_term(const Contact& c, Vec3r relative, Vec3r drift,
                                          Real inverse_mass, Real stiffness, Real thickness,
                                          Real dt) {
  const Real k = stiffness * c.area;
  const Real approach = dot(c.normal, relative);
  const Real predicted = c.gap + dt * (approach + dot(c.normal, drift));
  ContactTerm t{};
  if (!(predicted < thickness)) return t;
  // Along the normal: dt k (h − gap − dt n·Σ w (v + Δv)).
  const Real kn = dt * dt * k;
  const Real push = dt * k * (thickness - c.gap) - kn * approach;
  // Across: the drag s with which v̂ (1 − r) comes out of v̂ / (1 + s dt/m).
  const Vec3r free = relative + drift;
  const Vec3r slide = free - dot(c.normal, free) * c.normal;
  const Real speed = norm(slide);
  const Real pressure = std::fmax(dt * k * (thickness - predicted), Real(0)) /
                        (Real(1) + kn * inverse_mass);  // impulse that the solve will find
  const Real mass = Real(1) / inverse_mass;
  const Real r = speed > 0 ? c.friction * pressure * inverse_mass / speed : Real(0);
  Real drag = r < Real(0.999) ? mass * r / (1 - r) : Real(1e3) * mass;
  if (!(speed > 0)) drag = c.friction > 0 && pressure > 0 ? Real(1e3) * mass : Real(0);
  const Vec3r tangential = relative - approach * c.normal;
  const Vec3r n = c.normal;
  const Real d = kn - drag;
  t.h[0] = drag + d * n.x * n.x, t.h[1] = d * n.x * n.y, t.h[2] = d * n.x * n.z;
  t.h[3] = drag + d * n.y * n.y, t.h[4] = d * n.y * n.z, t.h[5] = drag + d * n.z * n.z;
  t.impulse = push * n - drag * tangential;
  return t;
}

}  // namespace icloth::ICLOTH_BUILD
