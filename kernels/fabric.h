// The stiffness of a fabric in its plane, as a function of the Green strain.
//
// Law and data: Wang, O'Brien, Ramamoorthi 2011, "Data-driven elastic models for cloth". Stress is
// S = C(strain)·ε with ε = FᵀF − I = 2G, hence k = 2c acts on the Green strain G. k is frozen
// during a step: with the secant k the measured law has no energy, with a frozen k the step
// minimises one. The orthotropic law has the same k at every strain, and an energy.
#pragma once

#include "kernels/angle.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// Stiffness against Green strain [N/m].
struct Stiffness {
  Real k11, k12, k22, k33;
};

/// A symmetric 2×2 matrix: strain or stress in the material axes u (weft) and v (warp).
struct Sym2 {
  Real uu, uv, vv;
};
ICLOTH_HD constexpr Sym2 operator+(Sym2 a, Sym2 b) {
  return {a.uu + b.uu, a.uv + b.uv, a.vv + b.vv};
}
ICLOTH_HD constexpr Sym2 operator-(Sym2 a, Sym2 b) {
  return {a.uu - b.uu, a.uv - b.uv, a.vv - b.vv};
}

/// A fabric as the kernels see it; see sim/scene/material.h.
struct Fabric {
  Real stretching[6][4];  ///< c11 c12 c22 c33 [N/m]
  Real bending[3][5];     ///< [N·m]
  Real damping;           ///< stiffness-proportional [s]
  bool measured;
  Real most_stiffness = 0;           ///< tensile_bound [N/m]
  Real limit_strain = 0;             ///< Green strain where it begins to harden; 0: never
  Real limit_stiffness = 0;          ///< largest extra stiffness beyond that [N/m]
  Real bending_spacing = 10;         ///< curvature between two samples of bending [1/m]
  Real bending_poisson = 0;          ///< for plate.h
  Real bending_friction = 0;         ///< HB, see yarn_friction.h [N]
  Real shear_friction = 0;           ///< HG [N/m]
  const Stiffness* table = nullptr;  ///< stiffness at the nodes of StiffnessTable, or null
};

/// A bound of k11 and k22 at any strain: all of them lie between the data.
ICLOTH_HD inline Real tensile_bound(const Fabric& fabric) {
  Real most = 0;
  for (const auto& row : fabric.stretching) most = std::fmax(most, std::fmax(row[0], row[2]));
  return 2 * most;
}

/// The largest principal stretch squared, which is the largest eigenvalue of FᵀF = 2G + I.
ICLOTH_HD inline Real largest_stretch2(Sym2 g) {
  const Real c11 = 2 * g.uu + 1, c22 = 2 * g.vv + 1, c12 = 2 * g.uv;
  const Real d = c11 - c22;
  return Real(0.5) * (c11 + c22 + std::sqrt(d * d + 4 * c12 * c12));
}

/// The measured law: bilinear between the rows of the table in direction, and in stretch up to 1/6.
ICLOTH_HD inline Stiffness measured_stiffness(const Fabric& fabric, Sym2 g) {
  const Real pi = Real(3.14159265358979323846);

  // φ is the direction of the largest stretch against the weft, from the eigenvector of FᵀF.
  const Real c12 = 2 * g.uv, lambda = largest_stretch2(g);
  const Real across = lambda - (2 * g.vv + 1);
  Real phi;
  if (c12 == 0)
    phi = g.uu >= g.vv ? Real(0) : pi / 2;
  else
    phi = angle_of(std::fabs(c12), std::fabs(across));

  // Rows 1 to 5 of the data were measured at directions π/8 apart, row 0 in the unstretched state.
  // The place of φ between two of them, and of the stretch between none and 1/6, are the weights.
  const Real a = std::fmin(8 * phi / pi, Real(4) - Real(1e-6));
  const int row = a < 0 ? 0 : (a >= 3 ? 3 : static_cast<int>(a));
  const Real along = a - static_cast<Real>(row);
  const Real stretch = std::sqrt(std::fmax(lambda, Real(0)));
  const Real s = std::fmin(std::fmax(6 * (stretch - 1), Real(0)), Real(1) - Real(1e-6));

  // The factor 2 leads from ε to the Green strain; negative data count as 0.
  Real c[4];
  for (int k = 0; k < 4; ++k) {
    const Real far =
        (1 - along) * fabric.stretching[1 + row][k] + along * fabric.stretching[2 + row][k];
    c[k] = 2 * std::fmax((1 - s) * fabric.stretching[0][k] + s * far, Real(0));
  }
  return {c[0], c[1], c[2], c[3]};
}

/// The measured law sampled on a grid of strains, with trilinear interpolation, as ARCSim does it
/// (Narain, Samii, O'Brien 2012). The grid is coarse against the range in which cloth is used; it
/// is kept for comparisons.
struct StiffnessTable {
  static constexpr int kNodes = 30;  ///< along each of G_uu, G_vv, |G_uv|
  static constexpr Index kSize = kNodes * kNodes * kNodes;

  /// The strain of a node. G_uu and G_vv start at −1/4, |G_uv| at 0; the spacing is 1/30.
  ICLOTH_HD static Sym2 strain(Index node) {
    const Real i = static_cast<Real>(node / (kNodes * kNodes));
    const Real j = static_cast<Real>(node / kNodes % kNodes);
    const Real k = static_cast<Real>(node % kNodes);
    const Real spacing = Real(1) / Real(kNodes);
    return {i * spacing - Real(0.25), k * spacing, j * spacing - Real(0.25)};
  }

  /// The stiffness at a strain, clamped to the grid.
  ICLOTH_HD static Stiffness look_up(const Stiffness* table, Sym2 g) {
    const Real place[3] = {(g.uu + Real(0.25)) * Real(kNodes), (g.vv + Real(0.25)) * Real(kNodes),
                           std::fabs(g.uv) * Real(kNodes)};

    // The strain lies in a cell of the grid, at these fractions of its edges.
    int cell[3];
    Real along[3];
    for (int a = 0; a < 3; ++a) {
      const Real inside = std::fmin(std::fmax(place[a], Real(0)), Real(kNodes - 1));
      cell[a] = inside >= Real(kNodes - 2) ? kNodes - 2 : static_cast<int>(inside);
      along[a] = inside - static_cast<Real>(cell[a]);
    }

    // The eight corners of the cell are weighted by the opposite volumes.
    Stiffness sum{0, 0, 0, 0};
    for (int corner = 0; corner < 8; ++corner) {
      Index node = 0;
      Real w = 1;
      for (int a = 0; a < 3; ++a) {
        const int far = corner >> a & 1;
        node = node * kNodes + cell[a] + far;
        w *= far != 0 ? along[a] : 1 - along[a];
      }
      const Stiffness& k = table[node];
      sum.k11 += w * k.k11;
      sum.k12 += w * k.k12;
      sum.k22 += w * k.k22;
      sum.k33 += w * k.k33;
    }
    return sum;
  }
};

struct FillStiffnessTable {
  Fabric fabric;
  View<Stiffness> table;  ///< (StiffnessTable::kSize)
  ICLOTH_HD void operator()(Index node) const {
    table[node] = measured_stiffness(fabric, StiffnessTable::strain(node));
  }
};

/// The stiffness at a strain. k12 is kept below 0.95 √(k11 k22), where the quadratic form in G is
/// positive definite (one published row is not).
ICLOTH_HD inline Stiffness stiffness_at(const Fabric& fabric, Sym2 g) {
  const Real* c = fabric.stretching[0];
  if (!fabric.measured) return {2 * c[0], 2 * c[1], 2 * c[2], 2 * c[3]};
  Stiffness k =
      fabric.table ? StiffnessTable::look_up(fabric.table, g) : measured_stiffness(fabric, g);
  k.k12 = std::fmin(k.k12, Real(0.95) * std::sqrt(k.k11 * k.k22));
  return k;
}

}  // namespace icloth::ICLOTH_BUILD
