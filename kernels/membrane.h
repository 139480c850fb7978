// In-plane forces of one face: Green strain, orthotropic or measured stress, PSD Hessian.
//
// Law and data: Wang, O'Brien, Ramamoorthi 2011, "Data-driven elastic models for cloth". Stress is
// S = C(strain)·ε with ε = FᵀF − I = 2G, hence k = 2c acts on the Green strain G. k is frozen
// during a step: with the secant k the law has no energy, with a frozen k the step minimises one.
#pragma once

#include "kernels/angle.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// Fabric as the kernels see it; see sim/material.h.
struct Fabric {
  Real stretching[6][4];  ///< c11 c12 c22 c33 [N/m]
  Real bending[3][5];     ///< [N·m]
  Real damping;           ///< stiffness-proportional [s]
  bool measured;
};

/// Stiffness against Green strain [N/m].
struct Stiffness {
  Real k11, k12, k22, k33;
};

/// Symmetric 2×2: strain or stress in material axes u (weft), v (warp).
struct Sym2 {
  Real uu, uv, vv;
};

/// Deformation gradient columns and the derivative weights of one face.
struct FaceFrame {
  Vec3r fu, fv;       ///< ∂x/∂u, ∂x/∂v
  Real bu[3], bv[3];  ///< ∂F_u/∂x_a = bu[a]·I, likewise v
};

/// inverse: rows r₀, r₁ of Dm⁻¹ [1/m].
ICLOTH_HD inline FaceFrame face_frame(const Vec3r x[3], const Real inverse[4]) {
  const Vec3r e0 = x[1] - x[0], e1 = x[2] - x[0];
  FaceFrame f;
  f.fu = inverse[0] * e0 + inverse[2] * e1;
  f.fv = inverse[1] * e0 + inverse[3] * e1;
  f.bu[1] = inverse[0], f.bu[2] = inverse[2], f.bu[0] = -(inverse[0] + inverse[2]);
  f.bv[1] = inverse[1], f.bv[2] = inverse[3], f.bv[0] = -(inverse[1] + inverse[3]);
  return f;
}

ICLOTH_HD inline Sym2 green_strain(const FaceFrame& f) {
  const Real half = Real(0.5);
  return {half * (dot(f.fu, f.fu) - Real(1)), half * dot(f.fu, f.fv),
          half * (dot(f.fv, f.fv) - Real(1))};
}

/// Largest principal stretch squared, the largest eigenvalue of FᵀF = 2G + I.
ICLOTH_HD inline Real largest_stretch2(Sym2 g) {
  const Real c11 = 2 * g.uu + 1, c22 = 2 * g.vv + 1, c12 = 2 * g.uv;
  const Real d = c11 - c22;
  return Real(0.5) * (c11 + c22 + std::sqrt(d * d + 4 * c12 * c12));
}

/// The measured law: bilinear between the rows in direction and in stretch up to 1/6.
ICLOTH_HD inline Stiffness measured_stiffness(const Fabric& fabric, Sym2 g) {
  const Real pi = Real(3.14159265358979323846);
  const Real c12 = 2 * g.uv, lambda = largest_stretch2(g);
  const Real across = lambda - (2 * g.vv + 1);
  Real phi;
  if (c12 == 0)
    phi = g.uu >= g.vv ? Real(0) : pi / 2;
  else
    phi = angle_of(std::fabs(c12), std::fabs(across));
  const Real a = std::fmin(8 * phi / pi, Real(4) - Real(1e-6));
  const int row = a < 0 ? 0 : (a >= 3 ? 3 : static_cast<int>(a));
  const Real along = a - static_cast<Real>(row);
  const Real stretch = std::sqrt(std::fmax(lambda, Real(0)));
  const Real s = std::fmin(std::fmax(6 * (stretch - 1), Real(0)), Real(1) - Real(1e-6));
  Real c[4];
  for (int k = 0; k < 4; ++k) {
    const Real far =
        (1 - along) * fabric.stretching[1 + row][k] + along * fabric.stretching[2 + row][k];
    c[k] = 2 * std::fmax((1 - s) * fabric.stretching[0][k] + s * far, Real(0));
  }
  return {c[0], c[1], c[2], c[3]};
}

/// Stiffness at a strain. k12 is kept below 0.95 √(k11 k22), where the quadratic form in G is
/// positive definite (one published row is not).
ICLOTH_HD inline Stiffness stiffness_at(const Fabric& fabric, Sym2 g) {
  Stiffness k;
  if (fabric.measured) {
    k = measured_stiffness(fabric, g);
  } else {
    const Real* c = fabric.stretching[0];
    k = {2 * std::fmax(c[0], Real(0)), 2 * std::fmax(c[1], Real(0)), 2 * std::fmax(c[2], Real(0)),
         2 * std::fmax(c[3], Real(0))};
  }
  k.k12 = std::fmin(k.k12, Real(0.95) * std::sqrt(k.k11 * k.k22));
  return k;
}

ICLOTH_HD inline Sym2 stress(const Stiffness& k, Sym2 g) {
  return {k.k11 * g.uu + k.k12 * g.vv, k.k33 * g.uv, k.k22 * g.vv + k.k12 * g.uu};
}

/// Energy per area for a frozen k [J/m²].
ICLOTH_HD inline Real membrane_energy(const Stiffness& k, Sym2 g) {
  return Real(0.5) * k.k11 * g.uu * g.uu + Real(0.5) * k.k22 * g.vv * g.vv + k.k12 * g.uu * g.vv +
         k.k33 * g.uv * g.uv;
}

/// Positive semi-definite part of a symmetric 2×2.
ICLOTH_HD inline Sym2 positive_part(Sym2 s) {
  const Real m = Real(0.5) * (s.uu + s.vv), h = Real(0.5) * (s.uu - s.vv);
  const Real d = std::sqrt(h * h + s.uv * s.uv);
  if (m - d >= 0) return s;
  if (m + d <= 0) return {0, 0, 0};
  // (m + d)·q qᵀ with q qᵀ = ½(I + (S − m I)/d)
  const Real scale = Real(0.5) * (m + d);
  return {scale * (1 + h / d), scale * s.uv / d, scale * (1 - h / d)};
}

/// Force on vertex a: f_a = −A F S B_aᵀ.
ICLOTH_HD inline Vec3r membrane_force(const FaceFrame& f, Sym2 s, Real area, int a) {
  const Real cu = s.uu * f.bu[a] + s.uv * f.bv[a], cv = s.uv * f.bu[a] + s.vv * f.bv[a];
  return -area * (cu * f.fu + cv * f.fv);
}

/// Hessian block (a, b): the frozen-k Hessian with the stress replaced by its positive part.
ICLOTH_HD inline Mat3r membrane_block(const FaceFrame& f, const Stiffness& k, Sym2 positive_stress,
                                      Real area, int a, int b) {
  const Real half = Real(0.5);
  // In the Hessian shear never vanishes: some measured rows have no shear stiffness at all.
  const Real shear = std::fmax(k.k33, Real(0.02) * std::sqrt(k.k11 * k.k22));
  const Vec3r sa = half * (f.bu[a] * f.fv + f.bv[a] * f.fu);
  const Vec3r sb = half * (f.bu[b] * f.fv + f.bv[b] * f.fu);
  const Vec3r row_u = (k.k11 * f.bu[a] * f.bu[b]) * f.fu + (k.k12 * f.bu[a] * f.bv[b]) * f.fv;
  const Vec3r row_v = (k.k22 * f.bv[a] * f.bv[b]) * f.fv + (k.k12 * f.bv[a] * f.bu[b]) * f.fu;
  const Real geometric = positive_stress.uu * f.bu[a] * f.bu[b] +
                         positive_stress.uv * (f.bu[a] * f.bv[b] + f.bv[a] * f.bu[b]) +
                         positive_stress.vv * f.bv[a] * f.bv[b];
  Mat3r h = outer(f.fu, row_u) + outer(f.fv, row_v) + outer(2 * shear * sa, sb);
  h += Mat3r::identity(geometric);
  return area * h;
}

}  // namespace icloth::ICLOTH_BUILD
