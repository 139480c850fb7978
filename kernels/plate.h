// Bending of one face as a plate: its curvature from the angles of its three hinges.
//
//   Λ = W (θ − θ_rest)        curvature in material axes (Λ_uu, Λ_vv, Λ_uv) [1/m]
//   E = ½ A Λᵀ D Λ            = ½ A (D11 Λ_uu² + D22 Λ_vv² + 2 D12 Λ_uu Λ_vv + 4 D33 Λ_uv²)
//
// W is constant and made for each face (sim/mechanics/plates.h), so that the stiffness depends far
// less on how the mesh is laid out than that of single hinges. The curvature is linear in the
// angles, so the same gradients ∂θ/∂x serve as for hinges.
#pragma once

#include "kernels/bending.h"

namespace icloth::ICLOTH_BUILD {

/// Rest data of a face, see sim/mechanics/plates.h.
struct PlateRest {
  Index hinge[3];  ///< −1 where there is none
  Real w[9];       ///< W, row after row: uu, vv, uv [1/m]
};

/// The places at which the two faces of a hinge keep its share: 3·face + slot, −1 for none.
struct HingeSlots {
  Index slot[2];
};

/// Bending moduli of a plate [N·m].
struct PlateModuli {
  Real d11, d22, d12, d33;
};

/// The angles of the three hinges beyond those at rest, 0 at a border.
ICLOTH_HD inline void plate_angles(const PlateRest& plate, View<const HingeRest> hinge,
                                   View<const Vec3r> x, Real angle[3]) {
  for (int slot = 0; slot < 3; ++slot) {
    const Index h = plate.hinge[slot];
    angle[slot] = h < 0 ? Real(0) : hinge_angle_of(hinge[h], x).theta - hinge[h].angle;
  }
}

/// Λ = W (θ − θ_rest); W keeps its rows in the order uu, vv, uv.
ICLOTH_HD inline Sym2 plate_curvature(const PlateRest& plate, const Real angle[3]) {
  const Real* w = plate.w;
  return {w[0] * angle[0] + w[1] * angle[1] + w[2] * angle[2],
          w[6] * angle[0] + w[7] * angle[1] + w[8] * angle[2],
          w[3] * angle[0] + w[4] * angle[1] + w[5] * angle[2]};
}

/// The size √(Λ : Λ) of a curvature, which is the same in every direction of a fold.
ICLOTH_HD inline Real curvature_size(Sym2 c) {
  return std::sqrt(c.uu * c.uu + c.vv * c.vv + 2 * c.uv * c.uv);
}

/// The measured moduli at a curvature. The three directions of the data give D11, D22 and the sum
/// D12 + 2 D33. The data do not tell those two apart, so D12 = ν √(D11 D22) with ν from the fabric.
/// D33 stays above a tenth of that of an isotropic plate, which the data of large curvatures do not
/// always do.
ICLOTH_HD inline PlateModuli plate_moduli(const Fabric& fabric, Sym2 curvature) {
  const BendingPlace place = bending_place(fabric, curvature_size(curvature));
  Real d[3];
  for (int r = 0; r < 3; ++r) d[r] = Real(0.25) * place.in(fabric.bending[r]);
  const Real mean = std::sqrt(d[0] * d[2]);

  // A hinge along u bends along v, so the directions change places.
  PlateModuli m;
  m.d11 = d[2], m.d22 = d[0];  // a hinge along u bends along v
  m.d12 = fabric.bending_poisson * mean;
  m.d33 = std::fmax(d[1] - Real(0.25) * (d[0] + d[2] + 2 * m.d12),
                    Real(0.05) * (1 - fabric.bending_poisson) * mean);
  return m;
}

/// The moments per width: the derivative of the energy per area in Λ_uu, Λ_vv, Λ_uv.
ICLOTH_HD inline Sym2 plate_moment(const PlateModuli& m, Sym2 c) {
  return {m.d11 * c.uu + m.d12 * c.vv, 4 * m.d33 * c.uv, m.d22 * c.vv + m.d12 * c.uu};
}

/// Energy per area [J/m²].
ICLOTH_HD inline Real plate_energy(const PlateModuli& m, Sym2 c) {
  const Sym2 moment = plate_moment(m, c);
  return Real(0.5) * (moment.uu * c.uu + moment.vv * c.vv + moment.uv * c.uv);
}

/// The derivative of area · energy in the angle of a slot, for the moment of a curvature.
ICLOTH_HD inline Real plate_torque(const PlateRest& plate, Sym2 moment, Real area, int slot) {
  return area * (plate.w[slot] * moment.uu + plate.w[3 + slot] * moment.vv +
                 plate.w[6 + slot] * moment.uv);
}

/// The second derivative of area · energy in the angles, A Wᵀ D W [N·m], in the order 00 01 02 11
/// 12 22.
struct PlateStiffness {
  Real k[6];
};
ICLOTH_HD inline PlateStiffness plate_stiffness(const PlateRest& plate, const PlateModuli& m,
                                                Real area) {
  Sym2 moment[3];
  for (int b = 0; b < 3; ++b)
    moment[b] = plate_moment(m, {plate.w[b], plate.w[6 + b], plate.w[3 + b]});
  PlateStiffness s;
  int n = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) s.k[n++] = plate_torque(plate, moment[b], area, a);
  return s;
}

/// Finds a diagonal matrix that is at least the stiffness, so that the matrix of the system keeps
/// the pattern of single hinges (13 blocks a row in place of 19). It is Gershgorin's bound of the
/// rows of the correlation K_ab / √(K_aa K_bb).
ICLOTH_HD inline void plate_bound(const PlateStiffness& s, Real bound[3]) {
  const Real scale[3] = {std::sqrt(s.k[0]), std::sqrt(s.k[3]), std::sqrt(s.k[5])};
  const Real k01 = std::fabs(s.k[1]), k02 = std::fabs(s.k[2]), k12 = std::fabs(s.k[4]);
  const Real inverse[3] = {scale[0] > 0 ? 1 / scale[0] : Real(0),
                           scale[1] > 0 ? 1 / scale[1] : Real(0),
                           scale[2] > 0 ? 1 / scale[2] : Real(0)};
  bound[0] = s.k[0] + scale[0] * (k01 * inverse[1] + k02 * inverse[2]);
  bound[1] = s.k[3] + scale[1] * (k01 * inverse[0] + k12 * inverse[2]);
  bound[2] = s.k[5] + scale[2] * (k02 * inverse[0] + k12 * inverse[1]);
}

}  // namespace icloth::ICLOTH_BUILD
