// In-plane forces of one face: the Green strain, the stress, and a positive semi-definite Hessian
// for a frozen stiffness.
#pragma once

#include "kernels/fabric.h"

namespace icloth::ICLOTH_BUILD {

/// The columns of the deformation gradient and the derivative weights of one face.
struct FaceFrame {
  Vec3r fu, fv;       ///< ∂x/∂u, ∂x/∂v
  Real bu[3], bv[3];  ///< ∂F_u/∂x_a = bu[a]·I, ∂F_v/∂x_a = bv[a]·I
};

/// The frame of a face from its corners. `inverse` holds the rows r₀, r₁ of Dm⁻¹ [1/m].
ICLOTH_HD inline FaceFrame face_frame(const Vec3r x[3], const Real inverse[4]) {
  const Vec3r e0 = x[1] - x[0], e1 = x[2] - x[0];
  FaceFrame f;
  f.fu = inverse[0] * e0 + inverse[2] * e1;
  f.fv = inverse[1] * e0 + inverse[3] * e1;
  f.bu[0] = -(inverse[0] + inverse[2]);
  f.bu[1] = inverse[0];
  f.bu[2] = inverse[2];
  f.bv[0] = -(inverse[1] + inverse[3]);
  f.bv[1] = inverse[1];
  f.bv[2] = inverse[3];
  return f;
}

/// G = ½ (FᵀF − I).
ICLOTH_HD inline Sym2 green_strain(const FaceFrame& f) {
  const Real half = Real(0.5);
  return {half * (dot(f.fu, f.fu) - Real(1)), half * dot(f.fu, f.fv),
          half * (dot(f.fv, f.fv) - Real(1))};
}

/// The second Piola-Kirchhoff stress of the orthotropic law at strain g [N/m].
ICLOTH_HD inline Sym2 stress(const Stiffness& k, Sym2 g) {
  return {k.k11 * g.uu + k.k12 * g.vv, k.k33 * g.uv, k.k22 * g.vv + k.k12 * g.uu};
}

/// Energy per area for a frozen k [J/m²].
ICLOTH_HD inline Real membrane_energy(const Stiffness& k, Sym2 g) {
  return Real(0.5) * k.k11 * g.uu * g.uu + Real(0.5) * k.k22 * g.vv * g.vv + k.k12 * g.uu * g.vv +
         k.k33 * g.uv * g.uv;
}

/// The positive semi-definite part of a symmetric 2×2 matrix.
ICLOTH_HD inline Sym2 positive_part(Sym2 s) {
  const Real m = Real(0.5) * (s.uu + s.vv), h = Real(0.5) * (s.uu - s.vv);
  const Real d = std::sqrt(h * h + s.uv * s.uv);
  if (m - d >= 0) return s;
  if (m + d <= 0) return {0, 0, 0};
  // One eigenvalue is positive: the part is (m + d)·q qᵀ with q qᵀ = ½(I + (S − m I)/d).
  const Real scale = Real(0.5) * (m + d);
  return {scale * (1 + h / d), scale * s.uv / d, scale * (1 - h / d)};
}

/// The force on vertex a: f_a = −A F S B_aᵀ.
ICLOTH_HD inline Vec3r membrane_force(const FaceFrame& f, Sym2 s, Real area, int a) {
  const Real cu = s.uu * f.bu[a] + s.uv * f.bv[a], cv = s.uv * f.bu[a] + s.vv * f.bv[a];
  return -area * (cu * f.fu + cv * f.fv);
}

/// Hessian block (a, b) for a frozen k, with the stress replaced by its positive part.
ICLOTH_HD inline Mat3r membrane_block(const FaceFrame& f, const Stiffness& k, Sym2 positive_stress,
                                      Real area, int a, int b) {
  const Real half = Real(0.5);

  // In the Hessian shear never vanishes: some measured rows have no shear stiffness at all.
  const Real shear = std::fmax(k.k33, Real(0.02) * std::sqrt(k.k11 * k.k22));

  // The material part is the stiffness between the derivatives of the strain components.
  const Vec3r sa = half * (f.bu[a] * f.fv + f.bv[a] * f.fu);
  const Vec3r sb = half * (f.bu[b] * f.fv + f.bv[b] * f.fu);
  const Vec3r row_u = (k.k11 * f.bu[a] * f.bu[b]) * f.fu + (k.k12 * f.bu[a] * f.bv[b]) * f.fv;
  const Vec3r row_v = (k.k22 * f.bv[a] * f.bv[b]) * f.fv + (k.k12 * f.bv[a] * f.bu[b]) * f.fu;

  // The geometric part is the stress between the derivative weights, the same in all three axes.
  const Real geometric = positive_stress.uu * f.bu[a] * f.bu[b] +
                         positive_stress.uv * (f.bu[a] * f.bv[b] + f.bv[a] * f.bu[b]) +
                         positive_stress.vv * f.bv[a] * f.bv[b];
  Mat3r h = outer(f.fu, row_u) + outer(f.fv, row_v) + outer(2 * shear * sa, sb);
  h += Mat3r::identity(geometric);
  return area * h;
}

}  // namespace icloth::ICLOTH_BUILD
