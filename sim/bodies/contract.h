// A slender copy of a body, for garments that have to start outside of it.
#pragma once

#include <array>
#include <vector>

#include "kernels/vec.h"

namespace icloth {

/// Contracts a closed surface by one implicit step of mean curvature flow, (M + t L) x' = M x with
/// t = length² and the cotangent Laplacian L (Desbrun et al. 1999, "Implicit fairing"). A cylinder
/// of radius r gets the radius r / (1 + t / r²): limbs thin out to lines before a trunk does, and
/// no part is turned inside out, as happens where a thin part is offset along its normals. Hollows
/// fill, so the result may reach a little out of the surface there.
void contract(std::vector<Vec3d>& positions, const std::vector<std::array<Index, 3>>& faces,
              double length);

}  // namespace icloth
