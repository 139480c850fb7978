// Friction between the yarns of the cloth (kernels/yarn_friction.h): its shares in the terms of
// faces and plates, its anchors and its work.
#pragma once

#include "sim/mechanics/force.h"

namespace icloth::ICLOTH_BUILD {

/// Friction against shear. Membrane adds it to each face: the stresses of the fabric and of its
/// friction make one force.
struct ShearFriction {
  View<const YarnAnchor> anchor;  ///< (cloth_faces); empty without yarn friction

  struct Law {
    Stiffness stiffness{0, 0, 0, 0};
    Sym2 stress{0, 0, 0};
  };

  ICLOTH_HD Law law(const FaceShape& f, const Linearization& point) const {
    Law law;
    if (anchor.size() == 0 || !(f.fabric.shear_friction > 0)) return law;
    const Real away = f.strain.uv - anchor[f.index].shear;
    law.stiffness.k33 = shear_friction_stiffness(
        f.fabric, point.moved() ? away : away + predicted_change(f, point));
    law.stress.uv = law.stiffness.k33 * away;
    return law;
  }

  /// Change of the strain G_uv over the predicted motion.
  ICLOTH_HD Real predicted_change(const FaceShape& f, const Linearization& point) const {
    Vec3r end[3];
    for (int a = 0; a < 3; ++a) end[a] = f.at[a] + point.predicted[f.v.v[a]];
    return f.strain_of(end).uv - f.strain.uv;
  }

  /// Adds the stiffness of the friction and what its stress adds to the positive part of the
  /// fabric's `elastic` stress. It is not damped, since its force ends at HG.
  ICLOTH_HD void add(const FaceShape& f, FaceTerm& t, const Linearization& point, const Law& law,
                     Sym2 elastic, Sym2 positive) const {
    if (!(law.stiffness.k33 > 0)) return;
    const Sym2 more = positive_part(elastic + law.stress) - positive;
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) {
        const Mat3r block = membrane_block(f.frame, law.stiffness, more, f.area, a, b);
        add_stiffness(t, f, point, a, b, block, 0);
      }
    }
  }
};

/// Friction against bending. Bending adds it to each plate.
struct BendingFriction {
  View<const YarnAnchor> anchor;  ///< (cloth_faces); empty without yarn friction

  struct Law {
    PlateModuli moduli;
    Sym2 moment;
  };

  ICLOTH_HD bool acts_on(const Fabric& fabric) const {
    return anchor.size() > 0 && fabric.bending_friction > 0;
  }

  /// From the curvatures of a face at the point of linearisation and after the predicted motion.
  ICLOTH_HD Law law(Index face, const Fabric& fabric, Sym2 at, Sym2 predicted, bool moved) const {
    const Sym2 away = predicted - anchor[face].curvature;
    const Sym2 looked_up = moved ? at - anchor[face].curvature : away;
    const PlateModuli moduli = bending_friction_moduli(fabric, looked_up);
    return {moduli, plate_moment(moduli, away)};
  }
};

class YarnFriction : public Force {
 public:
  /// Pulls the anchors along where the shape x0 is further from them than the slip. Repeated from
  /// the same shape, as when a substep is halved, it changes nothing but rounding.
  void begin_substep(const Topology& mesh, const Parameters& parameters, State& state);

  /// Work of the friction with the force that the law has at the candidate [J]. Where the step,
  /// linearised, had another force, the difference is an error of the step and shows in its energy
  /// balance.
  double work(const ForceContext& c, View<const Vec3r> dv) const;
};

/// Marks the faces whose linearised friction is further than `negligible` [N/m] from its law at the
/// candidate: a shear force per width, or a moment per width over the size of the face.
/// `predicted_end`: the shape of the prediction at which the friction of the first linearisation
/// was looked up [m] (≥ cloth_vertices).
void mark_wrong_friction(const ForceContext& c, View<const Vec3r> predicted_end, Real negligible,
                         View<std::uint8_t> to_renew);

/// Prepares the anchors at the start of a step as the fabrics and the model of bending need them.
/// Anchors of another kind are reset to the shape x1, where no friction acts; without yarn friction
/// there are none. Changes of the parameters between two steps leave no trace.
void match_yarns(const Topology& mesh, const Parameters& parameters, State& state);

}  // namespace icloth::ICLOTH_BUILD
