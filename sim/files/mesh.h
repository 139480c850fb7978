// Triangle meshes as they are read, before a scene is flattened for the solver.
#pragma once

#include <array>
#include <vector>

#include "kernels/vec.h"

namespace icloth {

using Triangle = std::array<Index, 3>;

struct TriangleMesh {
  std::vector<Vec3d> positions;  ///< [m] (V)
  std::vector<Triangle> faces;   ///< vertex indices, counter-clockwise seen from outside (F)
  std::vector<std::array<Vec2d, 3>> uv;  ///< material coordinates of the face corners [m] (F or 0)
};

}  // namespace icloth
