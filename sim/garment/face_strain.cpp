#include "sim/garment/face_strain.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"

namespace icloth {

double face_strain(const World& world, Index face, const std::array<Vec3d, 3>& x) {
  const Vec3d a = x[1] - x[0], b = x[2] - x[0];

  // The columns of the deformation gradient F, and the eigenvalues of FᵀF.
  const auto& m = world.face_inverse[at(face)];
  const Vec3d u = m[0] * a + m[2] * b, v = m[1] * a + m[3] * b;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
  const double largest = 0.5 * (uu + vv + std::hypot(uu - vv, 2 * uv));
  return std::sqrt(largest) - 1;
}

std::vector<double> face_strains(const World& world, std::span<const Vec3d> positions) {
  std::vector<double> strains;
  for (Index f = 0; f < world.cloth_faces; ++f) {
    const Triangle& t = world.face[at(f)];
    strains.push_back(
        face_strain(world, f, {positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]}));
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
