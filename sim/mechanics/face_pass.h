// The pass over all faces: it works out how a face is deformed once, and every force on faces adds
// its share to the same FaceTerm.
#pragma once

#include "kernels/strain_limit.h"
#include "sim/mechanics/element_terms.h"
#include "sim/mechanics/linearization.h"

namespace icloth::ICLOTH_BUILD {

/// A face at the point of linearisation, as the forces on it see it.
struct FaceShape {
  Index index;
  Int3 v;                ///< vertices
  const Fabric& fabric;  ///< its material
  const Real* inverse;   ///< rows of Dm⁻¹ [1/m]
  Real area;             ///< at rest [m²]
  Vec3r at[3];           ///< corners [m]
  Vec3r velocity[3];     ///< of the corners before the step [m/s]
  FaceFrame frame;       ///< deformation gradient at `at`
  Sym2 strain;           ///< Green strain at `at`

  /// Green strain of the face where its corners are elsewhere.
  ICLOTH_HD Sym2 strain_of(const Vec3r corners[3]) const {
    return green_strain(face_frame(corners, inverse));
  }
};

/// Adds the stiffness K between the corners a ≤ b of a face, and the impulse of its force over the
/// predicted motion. `damping`: time constant of the stiffness damping [s].
ICLOTH_HD inline void add_stiffness(FaceTerm& t, const FaceShape& f, const Linearization& point,
                                    int a, int b, const Mat3r& stiffness, Real damping) {
  const Mat3r h = point.dt * stiffness;
  t.block[block_slot(a, b)] += (point.dt + damping) * h;
  t.impulse[a] -= h * point.damped_motion(f.v.v[b], damping);
  if (b > a) t.impulse[b] -= transpose(h) * point.damped_motion(f.v.v[a], damping);
}

/// `Shares`: a Bundle of the shares of all forces (sim/mechanics/force.h).
template <class Shares>
struct FacePass {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  Linearization point;
  View<FaceTerm> term;
  Shares shares;

  ICLOTH_HD void operator()(Index i) const {
    if (point.keeps(i)) return;
    FaceShape f{.index = i,
                .v = face[i],
                .fabric = fabric[face_fabric[i]],
                .inverse = inverse[i].m,
                .area = area[i],
                .at = {},
                .velocity = {},
                .frame = {},
                .strain = {}};

    // The shape of the face is worked out once for all forces on it.
    for (int a = 0; a < 3; ++a) {
      f.at[a] = point.at[f.v.v[a]];
      f.velocity[a] = point.v[f.v.v[a]];
    }
    f.frame = face_frame(f.at, f.inverse);
    f.strain = green_strain(f.frame);

    // Their shares go into one term, so that the rows gather each face once.
    FaceTerm t{};
    shares.each([&](const auto& share) { share.add(f, t); });
    term[i] = t;
  }
};

}  // namespace icloth::ICLOTH_BUILD
