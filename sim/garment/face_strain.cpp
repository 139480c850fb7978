#include "sim/garment/face_strain.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"

namespace icloth {

std::vector<double> face_strains(const World& world, std::span<const Vec3d> positions) {
  std::vector<double> strains(at(world.cloth_faces));
  for (std::size_t f = 0; f < strains.size(); ++f) {
    const Triangle& t = world.face[f];
    const Vec3d a = positions[at(t[1])] - positions[at(t[0])];
    const Vec3d b = positions[at(t[2])] - positions[at(t[0])];

    // The columns of the deformation gradient F, and the eigenvalues of FᵀF.
    const auto& m = world.face_inverse[f];
    const Vec3d u = m[0] * a + m[2] * b, v = m[1] * a + m[3] * b;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
    const double largest = 0.5 * (uu + vv + std::hypot(uu - vv, 2 * uv));
    strains[f] = std::sqrt(largest) - 1;
  }
  return strains;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto last = static_cast<double>(values.size() - 1);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::lround(share * last));
  std::ranges::nth_element(values, place);
  return *place;
}

}  // namespace icloth
