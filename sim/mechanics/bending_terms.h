// Shares of single hinges and of plates in the system of the implicit step.
//
// Single hinges (material.bending=hinge) take one pass. Plates take three:
//
//   hinges   angle, its gradient and its predicted change
//   faces    curvature from three angles → torque on each of them, and a bound of the stiffness
//   hinges   the sum of both faces, as HingeTerm
//
// The right-hand side is that of the whole stiffness A Wᵀ D W; the matrix has its diagonal bound
// (plate_bound), with which a step stays stable and keeps the pattern of single hinges. Forces and
// states of rest are exact; an oscillation faster than a few steps dies out a little later.
#pragma once

#include "sim/mechanics/element_terms.h"
#include "sim/mechanics/linearization.h"
#include "sim/mechanics/yarns.h"

namespace icloth::ICLOTH_BUILD {

/// Time constant of the stiffness damping of a hinge between two fabrics [s].
ICLOTH_HD inline Real hinge_damping(const HingeRest& h, View<const Fabric> fabric, Real extra) {
  return std::fmin(fabric[h.fabric0].damping, fabric[h.fabric1].damping) + extra;
}

/// Change of the angle of a hinge over the predicted motion, damping included [rad].
ICLOTH_HD inline Real predicted_turn(const HingeRest& h, const HingeAngle& angle,
                                     const Linearization& point, Real damping) {
  Real turn = 0;
  for (int a = 0; a < 4; ++a)
    turn += dot(angle.gradient[a], point.damped_motion(h.v.v[a], damping));
  return turn;
}

/// Bending by single hinges.
struct HingeBending {
  View<const HingeRest> hinge;
  View<const Fabric> fabric;
  Linearization point;
  View<HingeTerm> term;
  Real extra_damping;  ///< on top of the fabric's [s]

  ICLOTH_HD void operator()(Index i) const {
    const HingeRest& h = hinge[i];
    const HingeAngle angle = hinge_angle_of(h, point.at);

    // In later iterations the stiffness stays that of the shape at the start.
    const Real start = point.moved() ? hinge_angle_of(h, point.start).theta : angle.theta;
    const Real k = hinge_stiffness(fabric[h.fabric0], fabric[h.fabric1], h, start);
    const Real damping = hinge_damping(h, fabric, extra_damping);
    const Real turn = predicted_turn(h, angle, point, damping);

    HingeTerm t;
    for (int a = 0; a < 4; ++a) t.gradient[a] = angle.gradient[a];
    t.stiffness = point.dt * (point.dt + damping) * k;
    t.impulse = -point.dt * k * (angle.theta - h.angle + turn);
    term[i] = t;
  }
};

/// A hinge between the passes of the plates.
struct HingeMotion {
  Real angle;  ///< beyond rest, at the point of linearisation [rad]
  Real turn;   ///< its predicted change, damping included [rad]
};

/// Whether a hinge stays as it was linearised first, because both of its faces do.
ICLOTH_HD inline bool keeps_hinge(const Linearization& point, const HingeSlots& slots) {
  return slots.slot[0] >= 0 && point.keeps(slots.slot[0] / 3) && point.keeps(slots.slot[1] / 3);
}

/// First pass of the plates. It writes the gradients of the terms; the last pass writes the rest.
struct HingeAngles {
  View<const HingeRest> hinge;
  View<const HingeSlots> slots;
  View<const Fabric> fabric;
  Linearization point;
  View<HingeMotion> motion;
  View<HingeTerm> term;
  Real extra_damping;  ///< on top of the fabric's [s]

  ICLOTH_HD void operator()(Index i) const {
    if (keeps_hinge(point, slots[i])) return;
    const HingeRest& h = hinge[i];
    const HingeAngle angle = hinge_angle_of(h, point.at);
    const Real damping = hinge_damping(h, fabric, extra_damping);
    motion[i] = {angle.theta - h.angle, predicted_turn(h, angle, point, damping)};
    for (int a = 0; a < 4; ++a) term[i].gradient[a] = angle.gradient[a];
  }
};

/// Share of one face in its three hinges.
struct PlateTerm {
  Real stiffness[3];  ///< dt (dt + d) · bound [kg m²]
  Real impulse[3];    ///< −dt · torque at the end of the step [N·m·s]
};

/// Second pass of the plates.
struct PlatePass {
  View<const PlateRest> plate;
  View<const HingeRest> hinge;
  View<const HingeSlots> slots;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  Linearization point;
  View<const HingeMotion> motion;
  View<const HingeTerm> hinge_term;  ///< gradients alone
  View<PlateTerm> term;
  Real extra_damping;  ///< on top of the fabric's [s]
  BendingFriction friction;
  View<std::uint8_t> renewed{};  ///< becomes 1 where the term is written, else 0 (faces)

  /// Whether the face and all of its hinges stay as they were linearised first.
  ICLOTH_HD bool keeps(Index i) const {
    bool all = point.keeps(i);
    for (const Index h : plate[i].hinge) all = all && (h < 0 || keeps_hinge(point, slots[h]));
    return all;
  }

  ICLOTH_HD void operator()(Index i) const {
    const bool same = keeps(i);
    if (renewed.size() > 0) renewed[i] = same ? 0 : 1;
    if (same) return;
    const PlateRest& p = plate[i];
    const Fabric& cloth = fabric[face_fabric[i]];

    // Angles at the start of the step, for the coefficients of the fabric, and at its end.
    Real start[3], end[3];
    for (int a = 0; a < 3; ++a) {
      const Index h = p.hinge[a];
      start[a] = end[a] = 0;
      if (h < 0) continue;
      start[a] = point.moved() ? hinge_angle_of(hinge[h], point.start).theta - hinge[h].angle
                               : motion[h].angle;
      end[a] = motion[h].angle + motion[h].turn;
    }

    // The friction of the yarns follows the elastic torques. It is not damped, as its moment ends
    // at HB.
    const PlateModuli moduli = plate_moduli(cloth, plate_curvature(p, start));
    PlateTerm t{};
    add(t, i, moduli, plate_moment(moduli, plate_curvature(p, end)),
        point.dt + cloth.damping + extra_damping);
    if (friction.acts_on(cloth)) {
      const BendingFriction::Law law = friction_law(i, cloth);
      add(t, i, law.moduli, law.moment, point.dt);
    }
    term[i] = t;
  }

  ICLOTH_HD void add(PlateTerm& t, Index i, const PlateModuli& m, Sym2 moment, Real delay) const {
    Real bound[3];
    plate_bound(plate_stiffness(plate[i], m, area[i]), bound);
    for (int a = 0; a < 3; ++a) {
      t.stiffness[a] += point.dt * delay * bound[a];
      t.impulse[a] -= point.dt * plate_torque(plate[i], moment, area[i], a);
    }
  }

  /// The angles change by the predicted motion alone, since the friction is not damped.
  ICLOTH_HD BendingFriction::Law friction_law(Index i, const Fabric& cloth) const {
    Real at[3], end[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = end[a] = 0;
      const Index h = plate[i].hinge[a];
      if (h < 0) continue;
      at[a] = end[a] = motion[h].angle;
      for (int b = 0; b < 4; ++b)
        end[a] += dot(hinge_term[h].gradient[b], point.predicted[hinge[h].v.v[b]]);
    }

    return friction.law(i, cloth, plate_curvature(plate[i], at), plate_curvature(plate[i], end),
                        point.moved());
  }
};

/// Last pass of the plates.
struct GatherPlates {
  View<const HingeSlots> slots;
  View<const PlateTerm> plate_term;
  HingeBending single;  ///< for edges of more than two faces, which no plate knows
  View<const std::uint8_t> plate_renewed{};  ///< see PlatePass; empty: all
  View<std::uint8_t> renewed{};              ///< the same of the hinges

  /// A hinge follows its plates: they are renewed with the faces that its gradient depends on.
  ICLOTH_HD bool follows(Index i) const {
    return plate_renewed.size() == 0 || plate_renewed[slots[i].slot[0] / 3] != 0 ||
           plate_renewed[slots[i].slot[1] / 3] != 0;
  }

  ICLOTH_HD void operator()(Index i) const {
    const bool is_single = slots[i].slot[0] < 0;
    const bool writes = is_single || follows(i);
    if (renewed.size() > 0) renewed[i] = writes ? 1 : 0;
    if (!writes) return;
    if (is_single) return single(i);
    HingeTerm& t = single.term[i];
    t.stiffness = t.impulse = 0;
    for (const Index slot : slots[i].slot) {
      t.stiffness += plate_term[slot / 3].stiffness[slot % 3];
      t.impulse += plate_term[slot / 3].impulse[slot % 3];
    }
  }
};

}  // namespace icloth::ICLOTH_BUILD
