// A meshed pattern with every triangle cut into four, so that what hangs on a body in few triangles
// goes on in many.
#pragma once

#include <array>
#include <vector>

#include "sim/pattern/sewing.h"

namespace icloth {

/// A finer pattern and where its points come from.
struct DividedPattern {
  MeshedPattern meshed;
  /// For each point of each panel the two points of the coarser panel that it lies in the middle
  /// of; a point that the coarser panel has already names it twice.
  std::vector<std::vector<std::array<Index, 2>>> parents;
};

/// Cuts all triangles of all panels into four at the middles of their edges. Curved outlines stay
/// the polygons that they are.
DividedPattern divide_pattern(const MeshedPattern& coarse);

/// Whether the divided pattern is sewn into the sewn coarse mesh with its triangles cut into four.
/// That is not so where sewing leaves triangles out, or joins both ends of edges that are not sewn
/// together themselves.
bool is_sewn_alike(const SewnGarment& coarse, const SewnGarment& fine);

}  // namespace icloth
