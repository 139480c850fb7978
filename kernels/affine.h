// Affine maps of space, the same text for host and device.
#pragma once

#include "kernels/vec.h"

namespace icloth {

/// x → A x + b. The three rows of the 3×4 matrix (A b), one after the other.
struct Affine {
  double m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  ICLOTH_HD Vec3d operator()(Vec3d x) const {
    return {m[0] * x.x + m[1] * x.y + m[2] * x.z + m[3],
            m[4] * x.x + m[5] * x.y + m[6] * x.z + m[7],
            m[8] * x.x + m[9] * x.y + m[10] * x.z + m[11]};
  }
  /// The map that applies b first.
  ICLOTH_HD friend Affine operator*(const Affine& a, const Affine& b) {
    Affine c;
    for (int row = 0; row < 12; row += 4) {
      const double* r = a.m + row;
      for (int k = 0; k < 4; ++k)
        c.m[row + k] = r[0] * b.m[k] + r[1] * b.m[4 + k] + r[2] * b.m[8 + k];
      c.m[row + 3] += r[3];
    }
    return c;
  }
};

}  // namespace icloth
