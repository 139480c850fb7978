// Curvature of each face as a function of the angles of its hinges (kernels/plate.h).
#pragma once

#include <array>
#include <vector>

#include "sim/scene/world.h"

namespace icloth {

/// Curvature operator of one face, Λ = W θ.
///
/// Two operators are known that are linear in the three angles of a face. One is exact on surfaces
/// of second degree: z = ½ pᵀ H p over the flat rest shape turns the hinge of an edge by θ = M H,
/// with M from the edge and the places of the two vertices opposite, and W = M⁻¹ is the curvature
/// of the quadratic through the six vertices. The other is the mid-edge operator W' = 1/(2A) Σ l
/// t⊗t of Grinspun, Gingold, Reisman and Zorin 2006, whose forces are exact: a constant moment is
/// in balance at every vertex. On a lattice, where each vertex sees the same neighbourhood, both
/// agree and all is exact. On other meshes neither has both properties: cloth finds a way to bend
/// with less energy past the first, which is too soft by up to a quarter, and the second is too
/// stiff by up to a half. Half way between them, (½ M + ½ W'⁻¹)⁻¹, the errors cancel to first
/// order: with the default 0.91 to 1.04 of the modulus on all meshes of
/// tests/sim/mechanics/bending_test.cpp, where single hinges have 0.84 to 3.
///
/// On a border, where an angle is not known, W gives the smallest curvature (√(H:H)) that fits the
/// others, as no moment acts across a free edge. Where six vertices lie near one conic M is nearly
/// singular, and the share of W' is larger.
struct FacePlate {
  std::array<Index, 3> hinge{-1, -1, -1};  ///< across the edge from corner a to the next
  /// W: rows Λ_uu, Λ_vv, Λ_uv [1/m], columns the hinges; 0 where there is none.
  std::array<double, 9> w{};
};

/// One a cloth face. Edges with more than two faces are left out (they stay single hinges).
std::vector<FacePlate> make_plates(const World& world);

}  // namespace icloth
