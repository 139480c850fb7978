// What one face (membrane, air) and one hinge (bending) add to the system of the implicit step.
#pragma once

#include "kernels/bending.h"
#include "kernels/strain_limit.h"
#include "sim/topology.h"

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
};

struct MembraneTerms {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  View<const Vec3r> x, v;
  View<FaceTerm> term;
  Real dt, damping_extra;
  Wind wind;

  ICLOTH_HD void operator()(Index i) const {
    const Int3 f = face[i];
    const Fabric& cloth = fabric[face_fabric[i]];
    const Vec3r xs[3] = {x[f.v[0]], x[f.v[1]], x[f.v[2]]};
    const Vec3r vs[3] = {v[f.v[0]], v[f.v[1]], v[f.v[2]]};
    const FaceFrame frame = face_frame(xs, inverse[i].m);
    const Sym2 g = green_strain(frame);
    const Stiffness k = stiffness_at(cloth, g);
    const StrainLimit limit = strain_limit(cloth, g);
    Sym2 s = stress(k, g);
    if (limit.active) s = s + limit_stress(limit);
    const Sym2 positive = positive_part(s);
    const FaceFrame principal = limit.active ? principal_frame(frame, limit) : frame;
    const Real delay = dt + cloth.damping + damping_extra;
    FaceTerm t;
    for (int a = 0; a < 3; ++a) t.impulse[a] = dt * membrane_force(frame, s, area[i], a);
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) {
        Mat3r h = membrane_block(frame, k, positive, area[i], a, b);
        if (limit.active) h += limit_block(principal, limit, area[i], a, b);
        h = (dt * delay) * h;
        t.block[block_slot(a, b)] = h;
        t.impulse[a] -= h * vs[b];
        if (b > a) t.impulse[b] -= transpose(h) * vs[a];
      }
    }
    if (wind.density > 0 || wind.drag > 0) add_air(t, xs, vs);
    term[i] = t;
  }

  /// Wind on one face: pressure ½-free form ρ A |v_n| v_n n plus a tangential drag, a third to
  /// each vertex; its derivative in the velocity goes to the diagonal.
  ICLOTH_HD void add_air(FaceTerm& t, const Vec3r xs[3], const Vec3r vs[3]) const {
    const Vec3r normal2 = cross(xs[1] - xs[0], xs[2] - xs[0]);
    const Real twice_area = norm(normal2);
    if (!(twice_area > 0)) return;
    const Real share = twice_area / Real(6);
    const Vec3r n = (Real(1) / twice_area) * normal2;
    const Vec3r relative = wind.velocity - (Real(1) / Real(3)) * (vs[0] + vs[1] + vs[2]);
    const Real vn = dot(n, relative);
    const Vec3r force =
        (share * wind.density * std::fabs(vn) * vn) * n + (share * wind.drag) * (relative - vn * n);
    const Real stiff = 2 * share * wind.density * std::fabs(vn), drag = share * wind.drag;
    const Mat3r h = dt * ((stiff - drag) * outer(n, n) + Mat3r::identity(drag));
    for (int a = 0; a < 3; ++a) {
      t.impulse[a] += dt * force;
      t.block[block_slot(a, a)] += h;
    }
  }
};

struct BendingTerms {
  View<const HingeRest> hinge;
  View<const Fabric> fabric;
  View<const Vec3r> x, v;
  View<HingeTerm> term;
  Real dt, damping_extra;

  ICLOTH_HD void operator()(Index i) const {
    const HingeRest& h = hinge[i];
    Vec3r xs[4];
    for (int a = 0; a < 4; ++a) xs[a] = x[h.v.v[a]];
    const HingeAngle angle = hinge_angle(xs);
    const Fabric &f0 = fabric[h.fabric0], &f1 = fabric[h.fabric1];
    const Real k = hinge_stiffness(f0, f1, h, angle.theta);
    const Real delay = dt + std::fmin(f0.damping, f1.damping) + damping_extra;
    Real rate = 0;
    for (int a = 0; a < 4; ++a) rate += dot(angle.gradient[a], v[h.v.v[a]]);
    HingeTerm t;
    for (int a = 0; a < 4; ++a) t.gradient[a] = angle.gradient[a];
    t.k = dt * delay * k;
    t.s = -dt * k * (angle.theta - h.angle + delay * rate);
    term[i] = t;
  }
};

}  // namespace icloth::ICLOTH_BUILD
