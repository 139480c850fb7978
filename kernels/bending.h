// Bending of one hinge: an interior edge of the mesh with its two faces.
//
//        2            The vertices of a hinge: its edge is (0,1); 2 lies opposite to it in the face
//       / \           (0,1,2), 3 in the face (0,3,1). The dihedral angle θ is 0 when it is flat.
//      0───1          E = ¼ c_b (θ − θ_rest)², c_b = k_e l² / (2 (A₀ + A₁)) with rest l and A
//       \ /           (law of ARCSim: Narain, Samii, O'Brien 2012; Wang et al. 2011 for the data).
//        3
#pragma once

#include "kernels/membrane.h"

namespace icloth::ICLOTH_BUILD {

/// Rest data of a hinge, see sim/scene/world.h.
struct HingeRest {
  Int4 v;
  Index fabric0, fabric1;  ///< materials of the two faces
  Real angle, length, area, direction, weight;
};

struct HingeAngle {
  Real theta;         ///< signed dihedral angle [rad]
  Vec3r gradient[4];  ///< ∂θ/∂x_a [1/m]
};

/// Returns θ = atan2(ê·(n₀×n₁), n₀·n₁) and its gradient. Heights are kept above 10⁻³ of the edge so
/// that slivers stay finite.
ICLOTH_HD inline HingeAngle hinge_angle(const Vec3r x[4]) {
  const Vec3r edge = x[1] - x[0];
  const Real length = std::fmax(norm(edge), Real(1e-12));
  const Vec3r e = (Real(1) / length) * edge;
  const Vec3r d2 = x[2] - x[0], d3 = x[3] - x[0];
  const Vec3r n0 = normalized(cross(edge, d2)), n1 = normalized(cross(d3, edge));

  // Moving vertex 2 or 3 along the normal turns its face about the edge, so the gradient there is
  // −n/h with the height h above the edge.
  const Real t0 = dot(d2, e) / length, t1 = dot(d3, e) / length;
  const Real smallest = Real(1e-3) * length;
  const Real h0 = std::fmax(norm(d2 - (t0 * length) * e), smallest);
  const Real h1 = std::fmax(norm(d3 - (t1 * length) * e), smallest);
  HingeAngle out;
  out.theta = angle_of(dot(e, cross(n0, n1)), dot(n0, n1));
  out.gradient[2] = (Real(-1) / h0) * n0;
  out.gradient[3] = (Real(-1) / h1) * n1;

  // The end points of the edge get the opposite of it, split by where the foot of each height lies,
  // so that a translation of the hinge changes no angle.
  out.gradient[0] = -(1 - t0) * out.gradient[2] - (1 - t1) * out.gradient[3];
  out.gradient[1] = -t0 * out.gradient[2] - t1 * out.gradient[3];
  return out;
}

ICLOTH_HD inline HingeAngle hinge_angle_of(const HingeRest& h, View<const Vec3r> x) {
  const Vec3r xs[4] = {x[h.v.v[0]], x[h.v.v[1]], x[h.v.v[2]], x[h.v.v[3]]};
  return hinge_angle(xs);
}

/// The place of a curvature among the samples of a row: the fraction `along` between the sample
/// `column` and the next one.
struct BendingPlace {
  int column;
  Real along;

  ICLOTH_HD Real in(const Real row[5]) const {
    return (1 - along) * row[column] + along * row[column + 1];
  }
};

/// Finds the place of a curvature. Beyond the last sample the stiffness stays as it is there.
/// `curvature` is given without its sign, since valley and mountain folds are equally stiff.
ICLOTH_HD inline BendingPlace bending_place(const Fabric& fabric, Real curvature) {
  const Real value =
      fabric.measured ? std::fmin(curvature / fabric.bending_spacing, Real(4)) : Real(0);
  const int column = value >= 3 ? 3 : static_cast<int>(value);
  return {column, value - static_cast<Real>(column)};
}

/// Measured bending stiffness k_e [N·m], linear between the curvature samples and between the
/// directions.
ICLOTH_HD inline Real bending_stiffness(const Fabric& fabric, const HingeRest& hinge, Real theta) {
  const BendingPlace place =
      bending_place(fabric, std::fabs(theta - hinge.angle) * hinge.length / hinge.area);

  // The three measured directions, 0, π/4 and π/2, are interpolated by the direction of the edge.
  const Real angle = hinge.direction * Real(4 / 3.14159265358979323846);
  const int row = angle >= 1 ? 1 : 0;
  const Real turn = std::fmin(std::fmax(angle - static_cast<Real>(row), Real(0)), Real(1));
  const Real k =
      (1 - turn) * place.in(fabric.bending[row]) + turn * place.in(fabric.bending[row + 1]);
  return std::fmax(k, Real(0));
}

/// ½ c_b [N·m], the second derivative of the energy in θ. Where the two faces are of different
/// fabrics the softer one decides.
ICLOTH_HD inline Real hinge_stiffness(const Fabric& side0, const Fabric& side1,
                                      const HingeRest& hinge, Real theta) {
  const Real k =
      std::fmin(bending_stiffness(side0, hinge, theta), bending_stiffness(side1, hinge, theta));
  return Real(0.25) * hinge.weight * k * hinge.length * hinge.length / hinge.area;
}

}  // namespace icloth::ICLOTH_BUILD
