// What one face (membrane, air) and one hinge (bending) add to the system of the implicit step.
#pragma once

#include "kernels/strain_limit.h"
#include "kernels/yarn_friction.h"
#include "sim/scene/parameters.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// One face's share of the system.
struct FaceTerm {
  Mat3r block[6];    ///< (0,0) (0,1) (0,2) (1,1) (1,2) (2,2) [kg]
  Vec3r impulse[3];  ///< right-hand side [N·s]
};

/// One hinge's share: blocks k g_a g_bᵀ, impulses s g_a.
struct HingeTerm {
  Vec3r gradient[4];
  Real k, s;
};

/// Upper-triangle storage of a face's symmetric 3×3 blocks.
ICLOTH_HD inline int block_slot(int a, int b) { return a == 0 ? b : (a == 1 ? b + 2 : 5); }

struct Wind {
  Vec3r velocity;      ///< [m/s]
  Real density, drag;  ///< [kg/m³], tangential [kg/(m² s)]

  ICLOTH_HD bool blows() const { return density > 0 || drag > 0; }
};

inline Wind wind_of(const Parameters& p) {
  return {{static_cast<Real>(p.wind.x), static_cast<Real>(p.wind.y), static_cast<Real>(p.wind.z)},
          static_cast<Real>(p.wind.air_density),
          static_cast<Real>(p.wind.air_drag)};
}

/// What the air does to each corner of a face: force − slope Δv of the corner.
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
  const Real share = twice_area / Real(6);
  const Vec3r n = (Real(1) / twice_area) * normal2;
  const Vec3r relative = wind.velocity - (Real(1) / Real(3)) * (vs[0] + vs[1] + vs[2]);
  const Real vn = dot(n, relative);
  const Real stiff = 2 * share * wind.density * std::fabs(vn), drag = share * wind.drag;
  return {
      (share * wind.density * std::fabs(vn) * vn) * n + (share * wind.drag) * (relative - vn * n),
      (stiff - drag) * outer(n, n) + Mat3r::identity(drag)};
}

/// Where the elastic forces are linearised: f(x1) ≈ f(at) − K(at) (x1 − at + d v1), d the time
/// constant of the stiffness damping, x1 = at + predicted + dt Δv. Yarn friction is linearised in
/// the same way without damping. Its K is the secant from the anchor to the predicted shape, at +
/// predicted, in the first iteration, and from the anchor to `at` in later ones.
struct Linearization {
  View<const Vec3r> start;      ///< x0; the coefficients of the fabric are those of this shape [m]
  View<const Vec3r> at;         ///< [m]
  View<const Vec3r> predicted;  ///< motion from `at` to x1 with Δv = 0 [m]
  View<const Vec3r> v;          ///< before the step [m/s]
  Real dt;                      ///< [s]

  /// After the first of several iterations.
  ICLOTH_HD bool moved() const { return at.data() != start.data(); }
  /// Factor of K on the right-hand side, predicted + d v [m].
  ICLOTH_HD Vec3r damped_motion(Index i, Real damping) const {
    return predicted[i] + damping * v[i];
  }
};

struct MembraneTerms {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  Linearization point;
  View<FaceTerm> term;
  Real damping_extra;
  Wind wind;
  View<const YarnAnchor> yarns{};  ///< empty without yarn friction

  /// Impulse of the stiffness h = dt K between two corners over the predicted motion.
  ICLOTH_HD void add_predicted_impulse(FaceTerm& t, Int3 f, int a, int b, const Mat3r& h,
                                       Real damping) const {
    t.impulse[a] -= h * point.damped_motion(f.v[b], damping);
    if (b > a) t.impulse[b] -= transpose(h) * point.damped_motion(f.v[a], damping);
  }

  ICLOTH_HD void operator()(Index i) const {
    const Int3 f = face[i];
    const Fabric& cloth = fabric[face_fabric[i]];
    const auto corners = [&](View<const Vec3r> x, Vec3r out[3]) {
      for (int a = 0; a < 3; ++a) out[a] = x[f.v[a]];
    };
    Vec3r at[3], v[3];
    corners(point.at, at);
    corners(point.v, v);
    const FaceFrame frame = face_frame(at, inverse[i].m);
    const Sym2 g = green_strain(frame);
    Sym2 start_strain = g;
    if (point.moved()) {
      Vec3r start[3];
      corners(point.start, start);
      start_strain = green_strain(face_frame(start, inverse[i].m));
    }
    const Stiffness k = stiffness_at(cloth, start_strain);
    const StrainLimit limit = strain_limit(cloth, g);
    Sym2 s = stress(k, g);
    if (limit.active) s = s + limit_stress(limit);
    Stiffness friction{};
    Sym2 held{0, 0, 0};  // by friction
    if (yarns.size() > 0 && cloth.shear_friction > 0) {
      const Real away = g.uv - yarns[i].shear;
      friction.k33 =
          shear_friction_stiffness(cloth, point.moved() ? away : away + predicted_shear(i, at, g));
      held.uv = friction.k33 * away;
    }
    const Sym2 positive = positive_part(s);
    const FaceFrame principal = limit.active ? principal_frame(frame, limit) : frame;
    const Real dt = point.dt, damping = cloth.damping + damping_extra;
    FaceTerm t;
    for (int a = 0; a < 3; ++a) t.impulse[a] = dt * membrane_force(frame, s + held, area[i], a);
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) {
        Mat3r h = membrane_block(frame, k, positive, area[i], a, b);
        if (limit.active) h += limit_block(principal, limit, area[i], a, b);
        h = dt * h;
        t.block[block_slot(a, b)] = (dt + damping) * h;
        add_predicted_impulse(t, f, a, b, h, damping);
      }
    }
    if (friction.k33 > 0) add_friction(t, i, frame, friction, positive_part(s + held) - positive);
    if (wind.blows()) add_air(t, at, v);
    term[i] = t;
  }

  /// How much G_uv changes where the cloth goes on as before.
  ICLOTH_HD Real predicted_shear(Index i, const Vec3r at[3], Sym2 g) const {
    Vec3r end[3];
    for (int a = 0; a < 3; ++a) end[a] = at[a] + point.predicted[face[i].v[a]];
    return green_strain(face_frame(end, inverse[i].m)).uv - g.uv;
  }

  /// Stiffness of the friction between yarns, and what its stress adds to the positive one; not
  /// damped, since its force ends at HG.
  ICLOTH_HD void add_friction(FaceTerm& t, Index i, const FaceFrame& frame,
                              const Stiffness& friction, Sym2 positive) const {
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) {
        const Mat3r h = point.dt * membrane_block(frame, friction, positive, area[i], a, b);
        t.block[block_slot(a, b)] += point.dt * h;
        add_predicted_impulse(t, face[i], a, b, h, 0);
      }
    }
  }

  ICLOTH_HD void add_air(FaceTerm& t, const Vec3r xs[3], const Vec3r vs[3]) const {
    const AirForce air = air_force(wind, xs, vs);
    const Mat3r h = point.dt * air.slope;
    for (int a = 0; a < 3; ++a) {
      t.impulse[a] += point.dt * air.force;
      t.block[block_slot(a, a)] += h;
    }
  }
};

struct BendingTerms {
  View<const HingeRest> hinge;
  View<const Fabric> fabric;
  Linearization point;
  View<HingeTerm> term;
  Real damping_extra;

  ICLOTH_HD void operator()(Index i) const {
    const HingeRest& h = hinge[i];
    const HingeAngle angle = hinge_angle_of(h, point.at);
    const Real start = point.moved() ? hinge_angle_of(h, point.start).theta : angle.theta;
    const Fabric &f0 = fabric[h.fabric0], &f1 = fabric[h.fabric1];
    const Real k = hinge_stiffness(f0, f1, h, start);
    const Real damping = std::fmin(f0.damping, f1.damping) + damping_extra;
    Real turn = 0;
    for (int a = 0; a < 4; ++a)
      turn += dot(angle.gradient[a], point.damped_motion(h.v.v[a], damping));
    HingeTerm t;
    for (int a = 0; a < 4; ++a) t.gradient[a] = angle.gradient[a];
    t.k = point.dt * (point.dt + damping) * k;
    t.s = -point.dt * k * (angle.theta - h.angle + turn);
    term[i] = t;
  }
};

}  // namespace icloth::ICLOTH_BUILD
