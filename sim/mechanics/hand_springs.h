// The force of the hands that hold the cloth: a damped spring on each vertex of their patches.
#pragma once

#include "sim/mechanics/force.h"

namespace icloth::ICLOTH_BUILD {

/// Critical damping of a spring on a mass [kg/s].
ICLOTH_HD inline Real critical_damping(Real stiffness, Real mass) {
  return 2 * std::sqrt(stiffness * mass);
}

/// Implicit, critically damped springs; they couple no vertices and add to the diagonal alone.
struct SpringRows {
  View<const Real> stiffness;  ///< [N/m], 0: none (cloth_vertices); empty where no hand holds
  View<const Vec3r> target;    ///< [m]
  View<const Real> mass;
  View<const Vec3r> x0, free_motion, v;
  Real dt;

  /// The springs are linear: what they add is the same in every iteration.
  ICLOTH_HD bool renews(Index) const { return false; }

  ICLOTH_HD void add(const RowBlock& at, Mat3r& sum, Vec3r& impulse) const {
    if (!at.diagonal || stiffness.size() == 0) return;
    const Index i = at.row;
    const Real k = stiffness[i];
    if (!(k > 0)) return;
    const Real c = critical_damping(k, mass[i]);
    sum += Mat3r::identity(dt * dt * k + dt * c);
    impulse += (dt * k) * (target[i] - (x0[i] + free_motion[i])) - (dt * c) * v[i];
  }
};

class HandSprings : public Force {
 public:
  SpringRows row_share(const ForceContext& c) const {
    const State& s = c.state;
    return {.stiffness = s.has_springs ? s.spring_stiffness.view() : View<const Real>{},
            .target = s.spring_target.view(),
            .mass = s.mass.view(),
            .x0 = s.x0.view(),
            .free_motion = c.free_motion,
            .v = c.point.v,
            .dt = c.point.dt};
  }
  /// Work of the springs and of their damping.
  double work(const ForceContext& c, View<const Vec3r> dv) const;
};

}  // namespace icloth::ICLOTH_BUILD
