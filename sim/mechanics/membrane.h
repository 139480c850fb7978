// The force of the fabric in its plane: stretching, shearing, and the limit of strain.
#pragma once

#include "sim/mechanics/force.h"
#include "sim/mechanics/yarns.h"

namespace icloth::ICLOTH_BUILD {

/// Stress and stiffness of one face. The shear friction of its yarns is added here, since the force
/// of the face is that of the sum of both stresses.
struct MembraneShare {
  Linearization point;
  Real extra_damping;  ///< on top of the fabric's [s]
  ShearFriction friction;

  ICLOTH_HD void add(const FaceShape& f, FaceTerm& t) const {
    // The coefficients of a measured fabric are frozen at the start of the step.
    Sym2 start_strain = f.strain;
    if (point.moved()) {
      Vec3r start[3];
      for (int a = 0; a < 3; ++a) start[a] = point.start[f.v.v[a]];
      start_strain = f.strain_of(start);
    }
    const Stiffness k = stiffness_at(f.fabric, start_strain);
    const StrainLimit limit = strain_limit(f.fabric, f.strain);

    // The stresses of the fabric and of the friction between its yarns make one force.
    Sym2 elastic = stress(k, f.strain);
    if (limit.active) elastic = elastic + limit_stress(limit);
    const ShearFriction::Law held = friction.law(f, point);
    for (int a = 0; a < 3; ++a)
      t.impulse[a] += point.dt * membrane_force(f.frame, elastic + held.stress, f.area, a);

    // Compression is left out of the geometric stiffness, which keeps it positive semi-definite.
    const Sym2 positive = positive_part(elastic);
    const FaceFrame principal = limit.active ? principal_frame(f.frame, limit) : f.frame;
    const Real damping = f.fabric.damping + extra_damping;
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) {
        Mat3r block = membrane_block(f.frame, k, positive, f.area, a, b);
        if (limit.active) block += limit_block(principal, limit, f.area, a, b);
        add_stiffness(t, f, point, a, b, block, damping);
      }
    }
    friction.add(f, t, point, held, elastic, positive);
  }
};

/// The largest principal stretch of a face, less 1, in a shape [m] (≥ cloth_vertices).
double largest_strain(const Topology& mesh, View<const Vec3r> x);

/// The most by which the largest stretch of a face grows from one shape to another one [m]
/// (≥ cloth_vertices each).
double largest_stretch(const Topology& mesh, View<const Vec3r> from, View<const Vec3r> to);

class Membrane : public Force {
 public:
  MembraneShare face_share(const ForceContext& c) const {
    return {c.point, static_cast<Real>(c.parameters.material.damping), {c.state.yarns.view()}};
  }
  /// Energy of the fabric in its plane, and its largest strain.
  void add_energy(const EnergyContext& c, ForceEnergy& energy) const;
};

}  // namespace icloth::ICLOTH_BUILD
