// Friction between the yarns of a fabric: cloth takes a moment and a shear force to be deformed
// beyond what its elasticity takes, holds itself up by them, and keeps folds when it is let go.
//
// Each face has one spring on the curvature and one on the shear strain. Both slip where they reach
// what the yarns hold: half the width of the hysteresis loops of the Kawabata tests, HB = 2HB/2 and
// HG = 2HG/2, or 2HG5/2 where the loop is wider at large angles (Grosberg 1966; internal friction
// in simulated cloth: Miguel et al. 2013, "Modeling and estimation of internal friction in cloth").
// Each spring remembers its anchor, the deformation at which it is slack.
//
//   moment = HB · away / max(|away|, slip)      away = curvature − anchor
#pragma once

#include "kernels/plate.h"

namespace icloth::ICLOTH_BUILD {

/// The deformation of a face. As the anchor of its yarns it is the one at which their friction
/// pulls nowhere.
struct YarnAnchor {
  Sym2 curvature;  ///< [1/m]
  Real shear;      ///< Green strain G_uv
};

/// The distance from the anchor at which the yarns begin to slip. It is our own choice: a
/// twenty-fifth of the curvature and a fourteenth of the angle that the Kawabata tests go to
/// (docs/deviations.md has others).
inline constexpr Real kCurvatureSlip = 10;       ///< [1/m]
inline constexpr Real kShearSlip = Real(0.005);  ///< G_uv; half the angle

/// The fraction of the distance from the anchor that exceeds the slip.
ICLOTH_HD inline Real yarn_excess(Real distance, Real slip) {
  return distance > slip ? 1 - slip / distance : Real(0);
}

/// The anchor after the cloth has come to a deformation: it is never further away than the slip.
ICLOTH_HD inline YarnAnchor dragged(const YarnAnchor& anchor, const YarnAnchor& now) {
  const Sym2 away = now.curvature - anchor.curvature;
  const Real bent = yarn_excess(curvature_size(away), kCurvatureSlip);
  const Real shear = now.shear - anchor.shear;
  const Sym2 c = anchor.curvature;
  return {{c.uu + bent * away.uu, c.uv + bent * away.uv, c.vv + bent * away.vv},
          anchor.shear + yarn_excess(std::fabs(shear), kShearSlip) * shear};
}

/// The moduli of the isotropic plate whose moment at a curvature away from the anchor is that of
/// the friction.
ICLOTH_HD inline PlateModuli bending_friction_moduli(const Fabric& fabric, Sym2 away) {
  const Real k = fabric.bending_friction / std::fmax(curvature_size(away), kCurvatureSlip);
  return {k, k, 0, Real(0.5) * k};
}

/// The stress S_uv of the friction over its strain G_uv away from the anchor [N/m].
ICLOTH_HD inline Real shear_friction_stiffness(const Fabric& fabric, Real away) {
  return fabric.shear_friction / std::fmax(std::fabs(away), kShearSlip);
}

/// The work per area of the friction on a face that comes from `start` to `end` [J/m²].
ICLOTH_HD inline Real yarn_work_density(const Fabric& fabric, const YarnAnchor& anchor,
                                        const YarnAnchor& start, const YarnAnchor& end) {
  const Sym2 away = end.curvature - anchor.curvature, bent = end.curvature - start.curvature;
  const Sym2 moment = plate_moment(bending_friction_moduli(fabric, away), away);
  const Real shear = end.shear - anchor.shear;
  const Real stress = shear_friction_stiffness(fabric, shear) * shear;
  return -(moment.uu * bent.uu + moment.vv * bent.vv + moment.uv * bent.uv) -
         2 * stress * (end.shear - start.shear);
}

}  // namespace icloth::ICLOTH_BUILD
