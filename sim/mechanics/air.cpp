#include "sim/mechanics/air.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Work of the air on one face [J].
struct AirWork {
  View<const Int3> face;
  View<const Real> inverse_mass;
  Linearization point;
  View<const Vec3r> dv, x0, x1;
  Wind wind;

  ICLOTH_HD double operator()(Index i) const {
    const View<const Vec3r> at = point.shape_of(i);
    Vec3r xs[3], vs[3];
    for (int a = 0; a < 3; ++a) {
      xs[a] = at[face[i].v[a]];
      vs[a] = point.v[face[i].v[a]];
    }
    const AirForce air = air_force(wind, xs, vs);

    // Prescribed vertices are moved by whatever prescribes them, and not by the air.
    double work = 0;
    for (const Index k : face[i].v) {
      if (inverse_mass[k] > 0) work += dot_double(air.force - air.slope * dv[k], x1[k] - x0[k]);
    }
    return work;
  }
};

}  // namespace

double Air::work(const ForceContext& c, View<const Vec3r> dv) const {
  const Wind wind = wind_of(c.parameters);
  if (!wind.blows()) return 0;

  // The work is that of the linearised force, which is the one that the solve applied.
  return reduce("implicit.air_work", c.mesh.cloth_faces, 0.0,
                AirWork{.face = c.mesh.face.view(),
                        .inverse_mass = c.state.inverse_mass.view(),
                        .point = c.point,
                        .dv = dv,
                        .x0 = c.state.x0.view(),
                        .x1 = c.state.candidate.view(),
                        .wind = wind},
                Sum{});
}

}  // namespace icloth::ICLOTH_BUILD
