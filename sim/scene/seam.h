// A seam that is open at the start and closes while the cloth is simulated (key "seams").
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

struct Seam {
  std::string name;
  Index from = 0, to = 0;  ///< cloths of its two sides, often the same
  /// Stitched vertices, one of each side, by their numbers in the meshes of their cloths.
  std::vector<std::array<Index, 2>> pairs;
  /// False: its pairs wait until a hand brings them near each other.
  bool pulls = true;
};

}  // namespace icloth
