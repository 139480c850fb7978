// Work that forces from outside did on the cloth in an implicit step. Part of the energy balance
// that a step reports; it changes nothing. The motion is x0 → candidate, the forces are those that
// the solve applied: linearised at `point`, with dv its solution (≥ cloth_vertices).
#pragma once

#include "kernels/parallel/parallel.h"
#include "sim/mechanics/elastic_terms.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

struct AirWork {
  View<const Int3> face;
  View<const Real> inverse_mass;
  View<const Vec3r> at, v, dv, x0, x1;
  Wind wind;

  /// Of a face [J].
  ICLOTH_HD double operator()(Index i) const {
    Vec3r xs[3], vs[3];
    for (int a = 0; a < 3; ++a) xs[a] = at[face[i].v[a]], vs[a] = v[face[i].v[a]];
    const AirForce air = air_force(wind, xs, vs);
    double work = 0;
    for (const Index k : face[i].v) {
      if (inverse_mass[k] > 0) work += dot_double(air.force - air.slope * dv[k], x1[k] - x0[k]);
    }
    return work;
  }
};

struct HandWork {
  View<const Real> stiffness, mass, inverse_mass;
  View<const Vec3r> target, v, dv, x0, x1;

  /// Of a vertex, by the spring of its hand and the spring's damping [J].
  ICLOTH_HD double operator()(Index i) const {
    const Real k = stiffness[i];
    if (!(k > 0) || !(inverse_mass[i] > 0)) return 0;
    const Real c = 2 * std::sqrt(k * mass[i]);
    return dot_double(k * (target[i] - x1[i]) - c * (v[i] + dv[i]), x1[i] - x0[i]);
  }
};

/// Work of the air on all faces [J]; 0 without air.
inline double air_work(const SubstepContext& step, const Linearization& point,
                       View<const Vec3r> dv) {
  const Wind wind = wind_of(step.parameters);
  if (!wind.blows()) return 0;
  const State& s = step.state;
  return reduce("implicit.air_work", step.mesh.cloth_faces, 0.0,
                AirWork{step.mesh.face.view(), s.inverse_mass.view(), point.at, point.v, dv,
                        s.x0.view(), s.candidate.view(), wind},
                Sum{});
}

/// Work of the springs of the hands, their damping included [J]; 0 without hands.
inline double hand_work(const SubstepContext& step, const Linearization& point,
                        View<const Vec3r> dv) {
  const State& s = step.state;
  if (!s.has_springs) return 0;
  return reduce("implicit.hand_work", step.mesh.cloth_vertices, 0.0,
                HandWork{s.spring_stiffness.view(), s.mass.view(), s.inverse_mass.view(),
                         s.spring_target.view(), point.v, dv, s.x0.view(), s.candidate.view()},
                Sum{});
}

}  // namespace icloth::ICLOTH_BUILD
