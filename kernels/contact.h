// Repulsion and friction of one VF or EE pair in proximity, linear in the motion of the step.
//
// Repulsion (paper Section 2.5): quadratic in the predicted gap; a pair whose gap will be below the
// thickness h pushes with N = k a (h − gap), a the area of its features.
//
// Friction is an elastic stick that slips at Coulomb's limit, after Cundall and Strack 1979, "A
// discrete numerical model for granular assemblies". The tangential force F that a pair ended the
// last substep with is carried over; the motion D_T along the contact adds −k a D_T to it, and the
// result is not longer than μN. It is the projection that an augmented Lagrangian of the stick
// constraint D_T = 0 makes (Alart and Curnier 1991), with the repulsion's k a as its penalty. Below
// the limit nothing creeps: the stick rests at a displacement of less than μ (h − gap).
#pragma once

#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// A pair in proximity, as found at the start of the step.
struct Contact {
  std::uint64_t key;
  Stencil s;       ///< gap vector g(x0) = Σ w x0
  Vec3r normal;    ///< unit, to the side of g, across both elements where these say so
  Vec3r held;      ///< tangential force at the end of the last substep [N]
  Index stuck;     ///< 1: it stuck then; 0: it slid, or was not in contact
  Real gap;        ///< normal · g [m]
  Real area;       ///< of the features [m²]
  Real friction;   ///< Coulomb coefficient
  Real thickness;  ///< h of the pair [m]
};

/// Symmetric 3×3 matrix.
struct Symmetric {
  Real m[6];  ///< xx xy xz yy yz zz
  ICLOTH_HD friend Vec3r operator*(const Symmetric& a, Vec3r v) {
    return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[1] * v.x + a.m[3] * v.y + a.m[4] * v.z,
            a.m[2] * v.x + a.m[4] * v.y + a.m[5] * v.z};
  }
  ICLOTH_HD Mat3r scaled(Real s) const {
    return {
        {s * m[0], s * m[1], s * m[2], s * m[1], s * m[3], s * m[4], s * m[2], s * m[4], s * m[5]}};
  }
};

/// The contribution of a contact to the system A Δv = b: H [kg] on the left, impulse [N·s] on the
/// right.
struct ContactTerm {
  Symmetric h;
  Vec3r impulse;  ///< Σ over corners with their weights
  Vec3r sliding;  ///< direction of the friction of a sliding pair, zero of one that sticks
  Index active;   ///< 0: the pair stays further apart than h and adds nothing
};

/// The part of `a` along the contact.
ICLOTH_HD inline Vec3r tangential(const Contact& c, Vec3r a) {
  return a - dot(c.normal, a) * c.normal;
}

/// The gap at the end of the step, where `motion` is Σ w (x1 − x0) [m].
ICLOTH_HD inline Real end_gap(const Contact& c, Vec3r motion) {
  return c.gap + dot(c.normal, motion);
}

/// The law of all contacts of a step.
struct ContactLaw {
  Real stiffness;  ///< k [N/m³]
  Real dt;         ///< from a change of velocity to a change of position [s]
};

/// The normal force N at the end of the step [N].
ICLOTH_HD inline Real normal_force(const Contact& c, const ContactLaw& law, Vec3r motion) {
  return law.stiffness * c.area * std::fmax(c.thickness - end_gap(c, motion), Real(0));
}

struct Friction {
  Vec3r force;   ///< tangential [N]
  bool sliding;  ///< at Coulomb's limit
};

/// The friction at the end of the step of a pair that presses with N = `normal` [N].
ICLOTH_HD inline Friction friction_of(const Contact& c, const ContactLaw& law, Vec3r motion,
                                      Real normal) {
  const Vec3r trial = tangential(c, c.held - (law.stiffness * c.area) * motion);
  const Real length = norm(trial), limit = c.friction * normal;
  if (length > limit) return {(limit / length) * trial, true};
  return {trial, false};
}

/// The motion of a contact in a step [m].
struct ContactMotion {
  Vec3r free;  ///< Σ w (x1 − x0) with Δv = 0
  Vec3r end;   ///< the same as solved; before that, as expected, equal to free
  bool solved;
};

/// Normal force that the present compression of a contact carries [N].
ICLOTH_HD inline Real carried_force(const Contact& c, const ContactLaw& law) {
  return law.stiffness * c.area * std::fmax(c.thickness - c.gap, Real(0));
}

/// The normal force from which friction follows [N]. Before the first solve it is what the present
/// compression carries plus what stops the approach, since the predicted gap alone would
/// overestimate it. The last two parameters are those of contact_term.
ICLOTH_HD inline Real friction_load(const Contact& c, const ContactLaw& law,
                                    const ContactMotion& motion, Real inverse_mass,
                                    const ContactTerm& last) {
  const Real normal = normal_force(c, law, motion.end);
  if (motion.solved && last.active != 0) return normal;
  const Real stop =
      std::fmax(-dot(c.normal, motion.end), Real(0)) / (law.dt * law.dt * inverse_mass);
  return std::fmin(normal, carried_force(c, law) + stop);
}

/// Whether a pair whose trial force exceeds its limit [N] comes to rest within the step all the
/// same.
ICLOTH_HD inline bool comes_to_rest(const Contact& c, const ContactLaw& law,
                                    const ContactMotion& motion, Real inverse_mass,
                                    const ContactTerm& last, Vec3r trial, Real limit) {
  // It does when it is found to slide in one direction after it was taken to slide in the opposite
  // one.
  if (motion.solved) return dot(last.sliding, trial) < 0;

  // Before a solve, a pair that stuck is expected to go on sticking, one that is under way to go on
  // sliding, and any other to come to rest where its sliding force alone would reverse its expected
  // motion.
  if (c.stuck != 0) return true;
  const Real k = law.stiffness * c.area, carried = carried_force(c, law);
  const bool under_way = carried > 0 && k * norm(tangential(c, motion.free)) > c.friction * carried;
  return !under_way && limit * law.dt * law.dt * inverse_mass > norm(tangential(c, motion.end));
}

/// Adds the tangential part to the impulse and to the stiffness h of a term.
ICLOTH_HD inline void add_friction(const Contact& c, const ContactLaw& law,
                                   const ContactMotion& motion, Real inverse_mass,
                                   const ContactTerm& last, ContactTerm& t, Mat3r& h) {
  const Vec3r n = c.normal;
  const Real k = law.stiffness * c.area, kdt2 = law.dt * law.dt * k;

  // Coulomb's projection starts from a trial force, that of a pair which sticks.
  const Real limit = c.friction * friction_load(c, law, motion, inverse_mass, last);
  const Vec3r start = tangential(c, motion.free), end = tangential(c, motion.end);
  const Vec3r held = tangential(c, c.held), trial = held - k * end;
  const Real length = norm(trial);

  // A sticking pair is a spring of stiffness k in both tangential directions.
  if (!(length > limit) || comes_to_rest(c, law, motion, inverse_mass, last, trial, limit)) {
    t.impulse += law.dt * (held - k * start);
    h += kdt2 * (Mat3r::identity(1) - outer(n, n));
    return;
  }

  // A sliding pair pulls with the limit along its trial force; across that direction the stiffness
  // is reduced by limit / length, as the derivative of the projection says.
  const Vec3r d = (Real(1) / length) * trial;
  t.sliding = d;
  const Real turn = limit / length;  // of k: what is left of it across d
  const Vec3r from = start - end;
  t.impulse += law.dt * (limit * d - (turn * k) * (from - dot(d, from) * d));
  h += (turn * kdt2) * (Mat3r::identity(1) - outer(n, n) - outer(d, d));
}

/// The term of one contact, linearised about motion.end: the normal part and, if `c.friction` > 0,
/// the tangential one. inverse_mass is Σ w²/m of the free corners [1/kg]; `last` is the term that
/// motion was solved with.
ICLOTH_HD inline ContactTerm contact_term(const Contact& c, const ContactLaw& law,
                                          const ContactMotion& motion, Real inverse_mass,
                                          const ContactTerm& last) {
  ContactTerm t{};
  if (!(end_gap(c, motion.end) < c.thickness)) return t;
  t.active = 1;

  // Repulsion: N = k a (h − gap) is linear in Δv as it is. Its derivative dt² k a n nᵀ goes to the
  // left side.
  const Vec3r n = c.normal;
  const Real k = law.stiffness * c.area;
  const Real approach = dot(n, motion.free);
  t.impulse = (law.dt * k * (c.thickness - c.gap - approach)) * n;
  Mat3r h = (law.dt * law.dt * k) * outer(n, n);
  if (c.friction > 0) add_friction(c, law, motion, inverse_mass, last, t, h);

  // Only six of the nine entries differ, as H is symmetric.
  t.h = {{h.m[0], h.m[1], h.m[2], h.m[4], h.m[5], h.m[8]}};
  return t;
}

/// The force with which the linear term acted when the motion came out as motion.end [N].
ICLOTH_HD inline Vec3r applied_force(const ContactTerm& t, const ContactLaw& law,
                                     const ContactMotion& motion) {
  const Vec3r dv = (Real(1) / law.dt) * (motion.end - motion.free);
  return (Real(1) / law.dt) * (t.impulse - t.h * dv);
}

}  // namespace icloth::ICLOTH_BUILD
