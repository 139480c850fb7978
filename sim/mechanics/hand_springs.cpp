#include "sim/mechanics/hand_springs.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Work of the spring of one vertex, and of its damping [J].
struct HandWork {
  View<const Real> stiffness, mass, inverse_mass;
  View<const Vec3r> target, v, dv, x0, x1;

  ICLOTH_HD double operator()(Index i) const {
    const Real k = stiffness[i];
    if (!(k > 0) || !(inverse_mass[i] > 0)) return 0;
    const Real c = critical_damping(k, mass[i]);
    return dot_double(k * (target[i] - x1[i]) - c * (v[i] + dv[i]), x1[i] - x0[i]);
  }
};

}  // namespace

double HandSprings::work(const ForceContext& c, View<const Vec3r> dv) const {
  const State& s = c.state;
  if (!s.has_springs) return 0;

  // The work is that of the force which the solve applied, damping included.
  return reduce("implicit.hand_work", c.mesh.cloth_vertices, 0.0,
                HandWork{.stiffness = s.spring_stiffness.view(),
                         .mass = s.mass.view(),
                         .inverse_mass = s.inverse_mass.view(),
                         .target = s.spring_target.view(),
                         .v = c.point.v,
                         .dv = dv,
                         .x0 = s.x0.view(),
                         .x1 = s.candidate.view()},
                Sum{});
}

}  // namespace icloth::ICLOTH_BUILD
