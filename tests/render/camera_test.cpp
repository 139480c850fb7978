#include "render/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/view_matrices.h"
#include "sim/scene/transforms.h"

namespace icloth {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kAspect = 640.0 / 480.0;
constexpr double kNoFloor = -1e9;

CameraPose pose() { return {"test", {0.4, 1.9, 2.2}, {0.1, 1.2, -0.3}, {0, 1, 0}, 40}; }

void expect_near(Vec3d a, Vec3d b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

/// Normalised device coordinates by the matrices that the renderer uses.
Vec3d through_matrices(const Camera& camera, Vec3d p) {
  const Eigen::Vector4d clip =
      projection_matrix(camera, kAspect) * (view_matrix(camera) * to_eigen(p)).homogeneous();
  return from_eigen(clip.hnormalized());
}

TEST(Camera, KeepsThePoseItIsGiven) {
  const Camera camera(pose());
  expect_near(camera.eye(), pose().eye, 1e-12);
  expect_near(camera.target(), pose().target, 0);
  EXPECT_EQ(camera.pose().fov, 40);
  const Camera again(camera.pose());
  expect_near(again.eye(), camera.eye(), 1e-12);
}

TEST(Camera, AxesAreOrthonormalAndLevel) {
  const Camera camera(pose());
  EXPECT_NEAR(norm(camera.forward()), 1, 1e-12);
  EXPECT_NEAR(norm(camera.up()), 1, 1e-12);
  EXPECT_NEAR(dot(camera.forward(), camera.right()), 0, 1e-12);
  EXPECT_EQ(camera.right().y, 0);
  EXPECT_GT(camera.up().y, 0);
}

TEST(Camera, ProjectionAgreesWithTheMatrices) {
  const Camera camera(pose());
  for (const Vec3d p : {Vec3d{0.1, 1.2, -0.3}, Vec3d{-0.4, 0.8, 0.2}, Vec3d{0.6, 1.7, -1}}) {
    const Projected pixel = camera.project(p, kWidth, kHeight);
    const Vec3d device = through_matrices(camera, p);
    EXPECT_NEAR(pixel.x, 0.5 * kWidth * (1 + device.x), 1e-9);
    EXPECT_NEAR(pixel.y, 0.5 * kHeight * (1 - device.y), 1e-9);
    EXPECT_GT(pixel.depth, 0);
    EXPECT_LT(std::abs(device.z), 1);  // between the near and the far plane
  }
}

TEST(Camera, RayGoesThroughThePointOfItsPixel) {
  const Camera camera(pose());
  const Vec3d p{-0.4, 0.8, 0.2};
  const Projected pixel = camera.project(p, kWidth, kHeight);
  const Ray ray = camera.ray(pixel.x, pixel.y, kWidth, kHeight);
  EXPECT_NEAR(norm(ray.direction), 1, 1e-12);
  EXPECT_NEAR(norm(cross(ray.direction, p - ray.origin)), 0, 1e-12);
  EXPECT_GT(dot(ray.direction, p - ray.origin), 0);
}

TEST(Camera, OrbitKeepsTheDistance) {
  Camera camera(pose());
  const double before = camera.distance();
  camera.orbit(37, -12, kHeight, kNoFloor);
  EXPECT_NEAR(norm(camera.eye() - camera.target()), before, 1e-12);
  EXPECT_GT(norm(camera.eye() - pose().eye), 0.1);
  camera.orbit(0, 10000, kHeight, kNoFloor);  // never over the pole
  EXPECT_LT(camera.forward().y, -0.99);
  EXPECT_GT(camera.up().y, 0);
  camera.orbit(0, -20000, kHeight, kNoFloor);
  EXPECT_GT(camera.forward().y, 0.99);
}

TEST(Camera, OrbitOverTheWholeHeightIsHalfATurn) {
  Camera camera(CameraPose{"", {0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 35});
  camera.orbit(kHeight, 0, kHeight, kNoFloor);
  expect_near(camera.eye(), {0, 0, -2}, 1e-9);
}

TEST(Camera, PanMovesTheTargetWithThePointer) {
  Camera camera(pose());
  const Vec3d target = camera.target();
  camera.pan(30, -20, kHeight);
  const Projected pixel = camera.project(target, kWidth, kHeight);
  EXPECT_NEAR(pixel.x, 0.5 * kWidth + 30, 1e-9);
  EXPECT_NEAR(pixel.y, 0.5 * kHeight - 20, 1e-9);
}

TEST(Camera, DollyKeepsThePointUnderThePointer) {
  Camera camera(pose());
  const Vec3d p{-0.2, 1.5, 0.1};
  const Projected before = camera.project(p, kWidth, kHeight);
  camera.dolly_to(0.7, p);
  const Projected after = camera.project(p, kWidth, kHeight);
  EXPECT_NEAR(after.x, before.x, 1e-9);
  EXPECT_NEAR(after.y, before.y, 1e-9);
  EXPECT_NEAR(after.depth, 0.7 * before.depth, 1e-9);
}

TEST(Camera, PivotLeavesTheEye) {
  Camera camera(pose());
  camera.set_pivot({0.5, 1, 0});
  expect_near(camera.eye(), pose().eye, 1e-9);
  expect_near(camera.target(), {0.5, 1, 0}, 0);
  const Projected centre = camera.project({0.5, 1, 0}, kWidth, kHeight);
  EXPECT_NEAR(centre.x, 0.5 * kWidth, 1e-9);
  EXPECT_NEAR(centre.y, 0.5 * kHeight, 1e-9);
}

TEST(Camera, FramesTheWholeBoxTightly) {
  const Vec3d low{-0.3, 0, -0.2}, high{0.4, 1.8, 0.3};
  for (const double aspect : {0.5, 1.0, 2.0}) {
    Camera camera(pose());
    camera.frame_box(low, high, aspect);
    const int width = static_cast<int>(kHeight * aspect);
    double widest = 0;
    for (int c = 0; c < 8; ++c) {
      const Vec3d p{c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z};
      const Projected pixel = camera.project(p, width, kHeight);
      widest = std::max(
          {widest, std::abs(2 * pixel.x / width - 1), std::abs(2 * pixel.y / kHeight - 1)});
    }
    EXPECT_LE(widest, 0.95);
    EXPECT_GE(widest, 0.85);
  }
}

TEST(Camera, EyeOnTheTargetIsMovedAway) {
  const Camera camera(CameraPose{"", {1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 35});
  EXPECT_GT(camera.distance(), 0);
  EXPECT_TRUE(std::isfinite(camera.ray(0, 0, kWidth, kHeight).direction.x));
}

TEST(Camera, StaysAboveTheFloorWhileItOrbits) {
  Camera camera(pose());
  camera.orbit(30, -10000, kHeight, 0.25);
  EXPECT_NEAR(camera.eye().y, 0.25, 1e-9);
  expect_near(camera.target(), pose().target, 0);

  // A target below the floor is seen from above.
  Camera above(pose());
  above.orbit(0, -10000, kHeight, 50);
  EXPECT_GT(above.eye().y, above.target().y + 0.99 * above.distance());
}

TEST(Camera, IsLiftedAboveTheFloorWithItsTarget) {
  Camera camera(pose());
  camera.lift_above(1);
  expect_near(camera.eye(), pose().eye, 1e-12);
  camera.lift_above(2.5);
  expect_near(camera.eye(), pose().eye + Vec3d{0, 0.6, 0}, 1e-12);
  expect_near(camera.target(), pose().target + Vec3d{0, 0.6, 0}, 1e-12);
}

TEST(Camera, LooksAlongADirectionFromItsDistance) {
  Camera camera(pose());
  const double distance = camera.distance();
  camera.look_along({2, 0, 0});
  expect_near(camera.eye(), pose().target - Vec3d{distance, 0, 0}, 1e-9);
  expect_near(camera.target(), pose().target, 0);
  camera.look_along({0, -1, 0});
  EXPECT_GT(camera.eye().y, camera.target().y + 0.99 * distance);
}

}  // namespace
}  // namespace icloth
