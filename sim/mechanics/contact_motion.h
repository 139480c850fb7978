// How contacts move in a substep, kept from pass to pass.
#pragma once

#include "kernels/contact.h"
#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {

/// The motion of one contact, Σ w (x1 − x0) over its corners.
struct ContactTravel {
  Vec3r free;     ///< with Δv = 0 [m]
  Vec3r end;      ///< with the present Δv [m]
  Real mobility;  ///< Σ w²/m of the free corners [1/kg]

  ICLOTH_HD ContactMotion motion(bool solved) const { return {free, end, solved}; }
};

/// What moves the vertices.
struct VertexMotion {
  View<const Vec3r> free;  ///< x1 − x0 with Δv = 0 [m] (vertices)
  View<const Real> inverse_mass;
  Real dt;  ///< from a change of velocity to one of position [s]

  /// The motion of a contact for Δv = `dv` [m/s] (cloth vertices).
  ICLOTH_HD ContactTravel travel(const Contact& c, View<const Vec3r> dv) const {
    ContactTravel t{apply(c.s, free), {}, 0};
    t.end = t.free + along(c, dv);
    for (int a = 0; a < 4; ++a) t.mobility += c.s.w[a] * c.s.w[a] * inverse_mass[c.s.v[a]];
    return t;
  }

  /// How a contact moves when the free vertices change their velocity [m].
  ICLOTH_HD Vec3r along(const Contact& c, View<const Vec3r> change) const {
    Vec3r sum{};
    for (int a = 0; a < 4; ++a) {
      const Index i = c.s.v[a];
      if (inverse_mass[i] > 0) sum += (dt * c.s.w[a]) * change[i];
    }
    return sum;
  }

  /// Motion of the cloth's side of a contact [m].
  ICLOTH_HD Vec3r of_cloth(const Contact& c, View<const Vec3r> dv) const {
    Vec3r sum{};
    for (int a = 0; a < 4; ++a) {
      const Index i = c.s.v[a];
      if (inverse_mass[i] > 0) sum += c.s.w[a] * (free[i] + dt * dv[i]);
    }
    return sum;
  }
};

}  // namespace icloth::ICLOTH_BUILD
