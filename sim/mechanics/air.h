// The force of the air on both sides of the cloth: wind and drag.
#pragma once

#include "sim/mechanics/force.h"

namespace icloth::ICLOTH_BUILD {

struct Wind {
  Vec3r velocity;      ///< [m/s]
  Real density, drag;  ///< [kg/m³], tangential [kg/(m² s)]

  ICLOTH_HD bool blows() const { return density > 0 || drag > 0; }
};

inline Wind wind_of(const Parameters& p) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  return {.velocity = {real(p.wind.x), real(p.wind.y), real(p.wind.z)},
          .density = real(p.wind.air_density),
          .drag = real(p.wind.air_drag)};
}

/// Force of the air on each corner of a face, linearised: force − slope Δv of the corner.
struct AirForce {
  Vec3r force;  ///< at the velocities given [N]
  Mat3r slope;  ///< [kg/s]
};

/// Wind on one face: pressure ½-free form ρ A |v_n| v_n n plus a tangential drag, a third to each
/// vertex; its derivative in the velocity goes to the diagonal.
ICLOTH_HD inline AirForce air_force(const Wind& wind, const Vec3r xs[3], const Vec3r vs[3]) {
  const Vec3r normal2 = cross(xs[1] - xs[0], xs[2] - xs[0]);
  const Real twice_area = norm(normal2);
  if (!(twice_area > 0)) return {};

  // The pressure acts along the normal and the drag across it; each corner has a third of both.
  const Real share = twice_area / Real(6);
  const Vec3r n = (Real(1) / twice_area) * normal2;
  const Vec3r relative = wind.velocity - (Real(1) / Real(3)) * (vs[0] + vs[1] + vs[2]);
  const Real vn = dot(n, relative);
  const Real stiff = 2 * share * wind.density * std::fabs(vn), drag = share * wind.drag;
  return {
      (share * wind.density * std::fabs(vn) * vn) * n + (share * wind.drag) * (relative - vn * n),
      (stiff - drag) * outer(n, n) + Mat3r::identity(drag)};
}

struct AirShare {
  Wind wind;
  Real dt;

  ICLOTH_HD void add(const FaceShape& f, FaceTerm& t) const {
    if (!wind.blows()) return;
    const AirForce air = air_force(wind, f.at, f.velocity);
    const Mat3r h = dt * air.slope;
    for (int a = 0; a < 3; ++a) {
      t.impulse[a] += dt * air.force;
      t.block[block_slot(a, a)] += h;
    }
  }
};

class Air : public Force {
 public:
  AirShare face_share(const ForceContext& c) const { return {wind_of(c.parameters), c.point.dt}; }
  double work(const ForceContext& c, View<const Vec3r> dv) const;
};

}  // namespace icloth::ICLOTH_BUILD
