// The limit of stretching: an energy on each principal strain that keeps cloth from going beyond
// it.
//
//   W(G) = φ(g₁) + φ(g₂), g₁ ≥ g₂ the eigenvalues of the Green strain
//   φ'' = K min(e / w, 1) for an excess e = g − g_limit > 0, else 0
//
// It is isotropic, twice differentiable and convex in G, so its tangent is positive semi-definite
// as it is.
#pragma once

#include "kernels/membrane.h"

namespace icloth::ICLOTH_BUILD {

/// w is the excess at which all of K has come in, about 2 % in terms of stretch.
inline constexpr double kLimitWidth = 0.02;

/// The stress and the tangent of the limit at one strain, in principal axes.
struct StrainLimit {
  bool active;
  Real qu, qv;      ///< first principal direction in material axes
  Real stress[2];   ///< φ'(g₁), φ'(g₂) [N/m]
  Real tangent[2];  ///< φ''(g₁), φ''(g₂)
  Real shear;       ///< (φ'(g₁) − φ'(g₂)) / (g₁ − g₂)
};

/// φ, φ' and φ'' at an excess e.
struct LimitCurve {
  Real stiffness;
  ICLOTH_HD Real energy(Real e) const {
    const Real w = Real(kLimitWidth);
    if (!(e > 0)) return 0;
    if (e < w) return stiffness * e * e * e / (6 * w);
    const Real beyond = e - w;
    return stiffness * (w * w / 6 + w * beyond / 2 + beyond * beyond / 2);
  }
  ICLOTH_HD Real stress(Real e) const {
    const Real w = Real(kLimitWidth);
    if (!(e > 0)) return 0;
    return e < w ? stiffness * e * e / (2 * w) : stiffness * (e - w / 2);
  }
  ICLOTH_HD Real tangent(Real e) const {
    return stiffness * std::fmin(std::fmax(e / Real(kLimitWidth), Real(0)), Real(1));
  }
};

/// A bound of the largest principal strain, by Gershgorin's theorem.
ICLOTH_HD inline Real strain_bound(Sym2 g) { return std::fmax(g.uu, g.vv) + std::fabs(g.uv); }

/// How far a linearisation of the limit at strain `at` is from its tension at strain `end`, as the
/// strain that makes up for it at full stiffness.
ICLOTH_HD inline Real missed_limit_strain(const Fabric& fabric, Sym2 at, Sym2 end) {
  if (!(fabric.limit_strain > 0)) return 0;
  const LimitCurve curve{1};
  const auto excess = [&](Sym2 g) {
    return Real(0.5) * (largest_stretch2(g) - 1) - fabric.limit_strain;
  };
  const Real from = excess(at), to = excess(end);
  return std::fabs(curve.stress(to) - curve.stress(from) - curve.tangent(from) * (to - from));
}

/// Evaluates the limit of a fabric at strain g.
ICLOTH_HD inline StrainLimit strain_limit(const Fabric& fabric, Sym2 g) {
  StrainLimit t{};
  if (!(fabric.limit_strain > 0)) return t;

  // The principal strains are m ± d. Nothing happens unless the larger one exceeds the limit.
  const Real m = Real(0.5) * (g.uu + g.vv), h = Real(0.5) * (g.uu - g.vv);
  const Real d = std::sqrt(h * h + g.uv * g.uv);
  const Real e[2] = {m + d - fabric.limit_strain, m - d - fabric.limit_strain};
  if (!(e[0] > 0)) return t;
  t.active = true;

  // The principal direction is the longer of two multiples of the eigenvector of m + d.
  const Real qu = h > 0 ? d + h : g.uv, qv = h > 0 ? g.uv : d - h;
  const Real length = std::sqrt(qu * qu + qv * qv);
  t.qu = length > 0 ? qu / length : Real(1);
  t.qv = length > 0 ? qv / length : Real(0);
  const LimitCurve curve{fabric.limit_stiffness};
  for (int i = 0; i < 2; ++i) t.stress[i] = curve.stress(e[i]), t.tangent[i] = curve.tangent(e[i]);

  // When both strains are nearly equal, the slope between them takes the place of the quotient.
  t.shear = 2 * d > Real(1e-3) ? (t.stress[0] - t.stress[1]) / (2 * d)
                               : curve.tangent(Real(0.5) * (e[0] + e[1]));
  return t;
}

/// The stress of the limit in material axes.
ICLOTH_HD inline Sym2 limit_stress(const StrainLimit& t) {
  const Real a = t.stress[0], b = t.stress[1];
  return {a * t.qu * t.qu + b * t.qv * t.qv, (a - b) * t.qu * t.qv,
          a * t.qv * t.qv + b * t.qu * t.qu};
}

/// Energy per area [J/m²].
ICLOTH_HD inline Real limit_energy(const Fabric& fabric, Sym2 g) {
  if (!(fabric.limit_strain > 0)) return 0;
  const Real m = Real(0.5) * (g.uu + g.vv), h = Real(0.5) * (g.uu - g.vv);
  const Real d = std::sqrt(h * h + g.uv * g.uv);
  const LimitCurve curve{fabric.limit_stiffness};
  return curve.energy(m + d - fabric.limit_strain) + curve.energy(m - d - fabric.limit_strain);
}

/// The frame of the face in principal axes, in which the tangent is that of an orthotropic fabric.
ICLOTH_HD inline FaceFrame principal_frame(const FaceFrame& f, const StrainLimit& t) {
  FaceFrame p;
  p.fu = t.qu * f.fu + t.qv * f.fv;
  p.fv = t.qu * f.fv - t.qv * f.fu;
  for (int a = 0; a < 3; ++a) {
    p.bu[a] = t.qu * f.bu[a] + t.qv * f.bv[a];
    p.bv[a] = t.qu * f.bv[a] - t.qv * f.bu[a];
  }
  return p;
}

/// Hessian block (a, b) of the limit without its geometric part, which goes with the stress.
ICLOTH_HD inline Mat3r limit_block(const FaceFrame& principal, const StrainLimit& t, Real area,
                                   int a, int b) {
  const Stiffness k{t.tangent[0], 0, t.tangent[1], t.shear};
  return membrane_block(principal, k, Sym2{0, 0, 0}, area, a, b);
}

}  // namespace icloth::ICLOTH_BUILD
