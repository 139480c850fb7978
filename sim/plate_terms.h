// Bending by plates: what the hinges add to the system of the implicit step, in three passes.
//
//   hinges   angle, its gradient and its rate
//   faces    curvature from three angles → torque on each of them, and a bound of the stiffness
//   hinges   the sum of both faces, as HingeTerm
//
// The right-hand side is that of the whole stiffness A Wᵀ D W; the matrix has its diagonal bound
// (plate_bound), with which a step stays stable and keeps the pattern of single hinges. Forces and
// states of rest are exact; an oscillation faster than a few steps dies out a little later.
#pragma once

#include "sim/elastic_terms.h"

namespace icloth::ICLOTH_BUILD {

/// One face's share of its three hinges.
struct PlateTerm {
  Real stiffness[3];  ///< dt (dt + d) · bound [kg m²]
  Real impulse[3];    ///< −dt · torque at the end of the step [N·m·s]
};

/// First pass: until the last, k and s of a term hold the angle beyond rest and how much K is ahead
/// of it (Linearization).
struct HingeAngles {
  View<const HingeRest> hinge;
  View<const Fabric> fabric;
  Linearization point;
  View<HingeTerm> term;
  Real damping_extra;

  ICLOTH_HD void operator()(Index i) const {
    const HingeRest& h = hinge[i];
    const HingeAngle angle = hinge_angle_of(h, point.at);
    const Real damping =
        std::fmin(fabric[h.fabric0].damping, fabric[h.fabric1].damping) + damping_extra;
    HingeTerm t;
    t.k = angle.theta - h.angle;
    t.s = 0;
    for (int a = 0; a < 4; ++a) {
      t.gradient[a] = angle.gradient[a];
      t.s += dot(angle.gradient[a], point.lead(h.v.v[a], damping));
    }
    term[i] = t;
  }
};

struct PlateTerms {
  View<const PlateRest> plate;
  View<const HingeRest> hinge;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  Linearization point;
  View<const HingeTerm> hinge_term;
  View<PlateTerm> term;
  Real damping_extra;
  View<const YarnAnchor> yarns{};  ///< empty where no yarns rub

  ICLOTH_HD void operator()(Index i) const {
    const PlateRest& p = plate[i];
    const Fabric& cloth = fabric[face_fabric[i]];
    Real start[3], end[3];
    for (int a = 0; a < 3; ++a) {
      const Index h = p.hinge[a];
      start[a] = end[a] = 0;
      if (h < 0) continue;
      start[a] = point.moved() ? hinge_angle_of(hinge[h], point.start).theta - hinge[h].angle
                               : hinge_term[h].k;
      end[a] = hinge_term[h].k + hinge_term[h].s;
    }
    const Sym2 curvature = plate_curvature(p, end);
    PlateModuli m = plate_moduli(cloth, plate_curvature(p, start));
    Sym2 moment = plate_moment(m, curvature);
    if (yarns.size() > 0 && cloth.bending_friction > 0) {
      const Sym2 away = curvature - yarns[i].curvature;
      const PlateModuli friction = bending_friction_moduli(cloth, away);
      moment = moment + plate_moment(friction, away);
      m.d11 += friction.d11, m.d22 += friction.d22, m.d33 += friction.d33;
    }
    const Real dt = point.dt, delay = dt + cloth.damping + damping_extra;
    PlateTerm t;
    plate_bound(plate_stiffness(p, m, area[i]), t.stiffness);
    for (int a = 0; a < 3; ++a) {
      t.stiffness[a] *= dt * delay;
      t.impulse[a] = -dt * plate_torque(p, moment, area[i], a);
    }
    term[i] = t;
  }
};

struct GatherPlates {
  View<const HingeSlots> slots;
  View<const PlateTerm> plate_term;
  View<const HingeRest> hinge;
  View<const Fabric> fabric;
  Linearization point;
  View<HingeTerm> term;
  Real damping_extra;

  ICLOTH_HD void operator()(Index i) const {
    if (slots[i].slot[0] < 0) {  // an edge of more than two faces
      BendingTerms{hinge, fabric, point, term, damping_extra}(i);
      return;
    }
    HingeTerm& t = term[i];
    t.k = t.s = 0;
    for (const Index slot : slots[i].slot) {
      t.k += plate_term[slot / 3].stiffness[slot % 3];
      t.s += plate_term[slot / 3].impulse[slot % 3];
    }
  }
};

}  // namespace icloth::ICLOTH_BUILD
