// Finds a start for a garment whose panels, as the pattern places them, go through the body or
// through each other: panels are bent and moved away, the body is made slender, and what still
// crosses is repaired.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/scene/scene.h"

namespace icloth {

/// What was tried for a garment.
struct Arrangement {
  double raised = 0;  ///< of the whole garment, where the pattern's origin is at the waist [m]
  std::size_t pairs_before = 0;  ///< of intersecting faces, as the pattern places the panels
  std::size_t pairs_moved = 0;   ///< after panels were bent and moved
  std::size_t pairs_left = 0;    ///< with slender bodies, too
  double contraction = 0;        ///< of bodies that start slender and grow back, by contract() [m]
  std::size_t repaired = 0;      ///< vertices that were moved one by one in the end
  int checks = 0;                ///< starts that were tested
  std::vector<std::string> moved;  ///< panels that stand elsewhere, a clause each
  std::vector<std::string>
      left;  ///< what still intersects, a clause each: "panel 'x' and body 'y'"
};

/// Arranges one garment among the bodies at time 0 and the garments `on`, numbers in
/// scene.garments, that are dressed already. Its placements, its cloth's start and the report are
/// those of the best arrangement; where it starts clean it is only raised, if at all.
Arrangement arrange_garment(Scene& scene, std::size_t garment, std::span<const std::size_t> on);

}  // namespace icloth
