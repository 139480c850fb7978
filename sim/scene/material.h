// Fabric parameters.
#pragma once

#include <array>
#include <string>

namespace icloth {

/// Fabric. Stretching and bending data are laid out as in the measured set of Wang, O'Brien and
/// Ramamoorthi 2011, "Data-driven elastic models for cloth: modeling and measurement".
struct Material {
  enum class Law {
    orthotropic,  ///< row 0 of `stretching` at every strain: hyperelastic
    measured,     ///< piecewise linear between the rows, frozen during a step
  };

  std::string name = "default";
  Law law = Law::measured;
  double density = 0.187;  ///< area density ρ [kg/m²], > 0
  double damping = 0.0;    ///< stiffness-proportional damping [s], ≥ 0
  /// Rows: at rest; then at 1/6 stretch along 0°, 22.5°, 45°, 67.5°, 90° from weft.
  /// Columns c11 c12 c22 c33 [N/m]; the stiffness that acts on Green strain is twice these.
  std::array<std::array<double, 4>, 6> stretching{};
  /// Rows: hinge along 0°, 45°, 90°; columns: curvature 0, 1, … 4 times bending_spacing [N·m].
  std::array<std::array<double, 5>, 3> bending{};
  double bending_spacing = 10;  ///< [1/m], > 0; 10 as in ARCSim (docs/deviations.md)
  double bending_poisson = 0;   ///< of the plate model: D12 = ν √(D11 D22), in (−0.95, 0.95)
  /// Internal friction of the yarns (kernels/yarn_friction.h): the largest moment per width [N] and
  /// the largest shear force per width [N/m] that it holds. They are half the widths 2HB and 2HG
  /// (or 2HG5) of the loops in the Kawabata tests; ≥ 0.
  double bending_friction = 0, shear_friction = 0;
  double strain_limit = 0;  ///< principal stretch − 1 where it begins to harden; 0: never
};

/// Constants of an orthotropic fabric as engineers give them.
struct OrthotropicFabric {
  double young_u = 0, young_v = 0;  ///< tensile stiffness along weft and warp [N/m], > 0
  double poisson = 0;               ///< ν_uv: contraction along v under tension along u
  double shear = 0;                 ///< G against the angle γ [N/m], > 0
  double bend_u = 0, bend_v = 0;    ///< moment per width and curvature along u and v [N·m]
  double bend_diagonal = -1;        ///< the same at 45°; < 0: that of a plate between u and v
  double bending_poisson = 0;       ///< of the bending alone
};

/// |ν| √(E_v / E_u), which must be below this; at 1 the fabric has no stiffness against some
/// strain.
inline constexpr double kLargestCoupling = 0.95;

/// Largest |c12| / √(c11 c22) of a row, its distance from being positive definite.
double coupling(const std::array<double, 4>& row);

/// Writes law, stretching and bending of a fabric whose values are in their ranges and whose
/// coupling is below kLargestCoupling.
void set_orthotropic(Material& material, const OrthotropicFabric& fabric);

/// Bending constants of a homogeneous sheet of a thickness [m] with the membrane constants of
/// `fabric`: an upper limit for cloth, whose yarns slide.
void bend_as_sheet(OrthotropicFabric& fabric, double thickness);

}  // namespace icloth
