// Contraction of bodies against what mean curvature flow does to spheres and cylinders.
#include "sim/bodies/contract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/index.h"
#include "sim/files/mesh.h"
#include "sim/scene/shapes.h"

namespace icloth {
namespace {

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& f : mesh.faces)
    sum +=
        dot(mesh.positions[at(f[0])], cross(mesh.positions[at(f[1])], mesh.positions[at(f[2])])) /
        6;
  return sum;
}

TEST(Contract, ShrinksASphereAsOneImplicitStepDoes) {
  // x' = x / (1 + 2 t / r²) on a sphere, whose position vector is an eigenfunction with 2 / r².
  for (double length : {0.02, 0.05, 0.1}) {
    TriangleMesh sphere = make_sphere(0.1, 2000);
    contract(sphere.positions, sphere.faces, length);
    const double expected = 0.1 / (1 + 2 * length * length / 0.01);
    double worst = 0;
    for (Vec3d p : sphere.positions) worst = std::max(worst, std::abs(norm(p) - expected));
    EXPECT_LT(worst, 0.02 * expected) << length;
  }
}

TEST(Contract, ThinsTheMiddleOfALongLimbAndDoesNotTurnItInsideOut) {
  // r' = r / (1 + t / r²) far from the ends of a cylinder. Offsetting by 6 cm would turn it.
  constexpr double kRadius = 0.04, kLength = 0.06;
  TriangleMesh limb = make_capsule(kRadius, 1, 4000);
  contract(limb.positions, limb.faces, kLength);
  const double expected = kRadius / (1 + kLength * kLength / (kRadius * kRadius));
  double worst = 0;
  int seen = 0;
  for (Vec3d p : limb.positions) {
    if (std::abs(p.y) > 0.1) continue;
    ++seen;
    worst = std::max(worst, std::abs(std::hypot(p.x, p.z) - expected));
  }
  EXPECT_LT(worst, 0.05 * expected);
  EXPECT_GT(seen, 100);
  EXPECT_GT(volume(limb), 0);
}

TEST(Contract, LeavesALoneWhatIsNotContracted) {
  TriangleMesh sphere = make_sphere(0.1, 200);
  const std::vector<Vec3d> before = sphere.positions;
  contract(sphere.positions, sphere.faces, 0);
  for (std::size_t v = 0; v < before.size(); ++v)
    EXPECT_LT(norm(sphere.positions[v] - before[v]), 1e-15);

  // A vertex without faces has nowhere to go.
  sphere.positions.push_back({1, 2, 3});
  contract(sphere.positions, sphere.faces, 0.05);
  EXPECT_EQ(sphere.positions.back(), (Vec3d{1, 2, 3}));
}

}  // namespace
}  // namespace icloth
