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
  /// Rows: hinge along 0°, 45°, 90°; columns: curvature samples 0…4 [N·m].
  std::array<std::array<double, 5>, 3> bending{};
};

}  // namespace icloth
