// Rotations between the forms that files and keyframes use.
#pragma once

#include "kernels/vec.h"

namespace icloth {

/// Matrix of a rotation vector (axis × angle [rad]), after Rodrigues.
inline Mat3<double> rotation_matrix(Vec3d rotation) {
  const double angle = norm(rotation);
  const Vec3d n = normalized(rotation);
  const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  return {{c + d * n.x * n.x, d * n.x * n.y - s * n.z, d * n.x * n.z + s * n.y,  //
           d * n.y * n.x + s * n.z, c + d * n.y * n.y, d * n.y * n.z - s * n.x,  //
           d * n.z * n.x - s * n.y, d * n.z * n.y + s * n.x, c + d * n.z * n.z}};
}

}  // namespace icloth
