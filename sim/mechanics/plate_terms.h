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

#include "sim/mechanics/elastic_terms.h"

namespace icloth::ICLOTH_BUILD {

/// One face's share of its three hinges.
struct PlateTerm {
  Real stiffness[3];  ///< dt (dt + d) · bound [kg m²]
  Real impulse[3];    ///< −dt · torque at the end of the step [N·m·s]
};

/// First pass: until the last, k and s of a term hold the angle beyond rest and its predicted
/// change (Linearization).
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
      t.s += dot(angle.gradient[a], point.damped_motion(h.v.v[a], damping));
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
  View<const YarnAnchor> yarns{};  ///< empty without yarn friction

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
    const PlateModuli m = plate_moduli(cloth, plate_curvature(p, start));
    const Sym2 moment = plate_moment(m, plate_curvature(p, end));
    const Real dt = point.dt;
    PlateTerm t{};
    add(t, i, m, moment, dt + cloth.damping + damping_extra);
    if (yarns.size() > 0 && cloth.bending_friction > 0) {
      Sym2 away, seen;
      curve_away(i, away, seen);
      const PlateModuli friction = bending_friction_moduli(cloth, seen);
      add(t, i, friction, plate_moment(friction, away), dt);  // not damped: its moment ends at HB
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

  /// Curvature away from the anchor: after the predicted motion, and where the friction is looked
  /// up.
  ICLOTH_HD void curve_away(Index i, Sym2& away, Sym2& seen) const {
    Real at[3], end[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = end[a] = 0;
      const Index h = plate[i].hinge[a];
      if (h < 0) continue;
      const HingeTerm& t = hinge_term[h];
      at[a] = end[a] = t.k;
      for (int b = 0; b < 4; ++b) end[a] += dot(t.gradient[b], point.predicted[hinge[h].v.v[b]]);
    }
    away = plate_curvature(plate[i], end) - yarns[i].curvature;
    seen = point.moved() ? plate_curvature(plate[i], at) - yarns[i].curvature : away;
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
