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
  Stencil s;       ///< gap vector g(x0) = Σ w x0
  Vec3r normal;    ///< unit, along g
  Real gap;        ///< |g| [m]
  Real area;       ///< of the features [m²]
  Real friction;   ///< Coulomb coefficient
  Real thickness;  ///< h of the pair [m]
};

/// What a contact adds to the system A Δv = b: H [kg] on the left, impulse [N·s] on the right.
struct ContactTerm {
  Real h[6];      ///< symmetric: xx xy xz yy yz zz
  Vec3r impulse;  ///< Σ over corners with their weights
  Index active;   ///< 0: the pair stays further apart than h and adds nothing
};

ICLOTH_HD inline Vec3r multiply(const ContactTerm& t, Vec3r v) {
  return {t.h[0] * v.x + t.h[1] * v.y + t.h[2] * v.z, t.h[1] * v.x + t.h[3] * v.y + t.h[4] * v.z,
          t.h[2] * v.x + t.h[4] * v.y + t.h[5] * v.z};
}

/// Gap at the end of a step of relative velocity `relative` [m].
ICLOTH_HD inline Real end_gap(const Contact& c, Vec3r relative, Real dt) {
  return c.gap + dt * dot(c.normal, relative);
}

struct ContactLaw {
  Real stiffness;  ///< k [N/m³]
  Real dt;         ///< [s]
};

/// start: Σ w v at the start of the step; end: the same at its end, expected (from gravity alone)
/// or solved [m/s]; inverse_mass: Σ w²/m of the free corners [1/kg].
ICLOTH_HD inline ContactTerm contact_term(const Contact& c, const ContactLaw& law, Vec3r start,
                                          Vec3r end, bool solved, Real inverse_mass) {
  ContactTerm t{};
  const Real predicted = end_gap(c, end, law.dt);
  if (!(predicted < c.thickness)) return t;
  t.active = 1;
  // Along the normal: dt k a (h − gap − dt n·Σ w (v + Δv)).
  const Real k = law.stiffness * c.area, kn = law.dt * law.dt * k;
  const Real approach = dot(c.normal, start);
  const Real push = law.dt * k * (c.thickness - c.gap) - kn * approach;
  // Across: Coulomb's impulse μN as a drag. Before a solve, the drag with which the expected slide
  // v̂ (1 − r), r = μN/(m|v̂|), comes out of v̂ / (1 + drag/m); after one, the secant μN/|v|.
  Real normal_impulse = law.dt * k * (c.thickness - predicted);
  // Before a solve: what the present compression carries, and what stops the approach.
  const Real carried = law.dt * k * std::fmax(c.thickness - c.gap, Real(0));
  const Real stop = std::fmax(-approach, Real(0)) / inverse_mass;
  if (!solved) normal_impulse = std::fmin(normal_impulse, carried + stop);
  const Vec3r slide = end - dot(c.normal, end) * c.normal;
  const Real speed = norm(slide), limit = c.friction * normal_impulse;
  const Real mass = Real(1) / inverse_mass, stick = Real(1e3) * mass;
  Real drag = stick;
  if (limit < stick * speed) {
    drag = limit / speed;
    const Real r = drag * inverse_mass;
    if (!solved) drag = r < Real(0.999) ? drag / (1 - r) : stick;
  }
  if (!(limit > 0)) drag = 0;
  const Vec3r tangential = start - approach * c.normal;
  const Vec3r n = c.normal;
  const Real d = kn - drag;
  t.h[0] = drag + d * n.x * n.x, t.h[1] = d * n.x * n.y, t.h[2] = d * n.x * n.z;
  t.h[3] = drag + d * n.y * n.y, t.h[4] = d * n.y * n.z, t.h[5] = drag + d * n.z * n.z;
  t.impulse = push * n - drag * tangential;
  return t;
}

}  // namespace icloth::ICLOTH_BUILD
