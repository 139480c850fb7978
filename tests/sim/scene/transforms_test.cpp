// Where rotations put bodies and cloths, against the formula of Rodrigues written out.
#include "sim/scene/transforms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "sim/scene/scene_io.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

constexpr double kTolerance = 1e-12;  // [m], of bodies a few metres large

/// The matrix of a rotation vector (axis × angle [rad]).
Mat3<double> rodrigues(Vec3d rotation) {
  const Vec3d n = normalized(rotation);
  const double angle = norm(rotation), c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  return {{c + d * n.x * n.x, d * n.x * n.y - s * n.z, d * n.x * n.z + s * n.y,  //
           d * n.y * n.x + s * n.z, c + d * n.y * n.y, d * n.y * n.z - s * n.x,  //
           d * n.z * n.x - s * n.y, d * n.z * n.y + s * n.x, c + d * n.z * n.z}};
}

Vec3d radians(Vec3d degrees) { return std::numbers::pi / 180 * degrees; }

/// Turns about x, then y, then z.
Vec3d turned_in_turn(Vec3d degrees, Vec3d p) {
  const Vec3d a = radians(degrees);
  return rodrigues({0, 0, a.z}) * (rodrigues({0, a.y, 0}) * (rodrigues({a.x, 0, 0}) * p));
}

std::mt19937 generator(11);

Vec3d random_vector(double size) {
  std::uniform_real_distribution<double> number(-size, size);
  return {number(generator), number(generator), number(generator)};
}

/// Angles that are special to rotations, and random ones.
std::vector<Vec3d> triples_of_degrees() {
  std::vector<Vec3d> triples;
  for (const double x : {-180., 0., 90., 180.})
    for (const double y : {-90., 0., 90., 360.})
      for (const double z : {0., 1e-7, 180., -270.}) triples.push_back({x, y, z});
  for (int k = 0; k < 50; ++k) triples.push_back(random_vector(400));
  return triples;
}

std::string json(Vec3d v) {
  char text[100];
  std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", v.x, v.y, v.z);
  return text;
}

/// A scene with one body, a box 2 m large, that has the given further keys.
std::shared_ptr<const Scene> scene_with_box(const std::string& keys) {
  static const TemporaryFolder folder;
  const std::string text = R"({"cloths": [{"mesh": {"grid": {"size": [1, 1]}}, "triangles": 8}],
      "obstacles": [{"mesh": {"box": {"size": [2, 2, 2], "edge": 2}}, )" +
                           keys + "}]}";
  return load_scene(folder.write("a.json", text), {});
}

std::vector<Vec3d> pose_at(const Obstacle& obstacle, double time) {
  std::vector<Vec3d> positions;
  obstacle.pose(time, positions);
  return positions;
}

TEST(Transforms, KeyframesTurnAndMoveABodyByTheFormulaOfRodrigues) {
  Obstacle body;
  for (int k = 0; k < 20; ++k) body.mesh.positions.push_back(random_vector(2));

  // Turns of many sizes, with more than a whole one among them.
  for (int k = 0; k < 500; ++k) {
    const double size = std::pow(10., k % 10 - 8);
    const Keyframe a{0, random_vector(3), random_vector(size)},
        b{1, random_vector(3), random_vector(size)};
    body.motion = {a, b};
    for (const double s : {0., 0.3, 1.}) {
      const Mat3<double> rotation = rodrigues((1 - s) * a.rotation + s * b.rotation);
      const Vec3d translation = (1 - s) * a.translation + s * b.translation;
      const std::vector<Vec3d> posed = pose_at(body, s);
      for (std::size_t v = 0; v < posed.size(); ++v)
        EXPECT_LE(norm(posed[v] - (rotation * body.mesh.positions[v] + translation)), kTolerance)
            << "turn " << json(a.rotation) << " to " << json(b.rotation) << " at " << s;
    }
  }
}

TEST(Transforms, ARotationOfZeroKeepsEveryBit) {
  Obstacle body;
  for (int k = 0; k < 20; ++k) body.mesh.positions.push_back(random_vector(2));
  body.motion = {{0, {}, {}}};
  EXPECT_EQ(pose_at(body, 0), body.mesh.positions);
}

TEST(Transforms, ATransformTurnsAboutTheAxesInTurnAfterItsScale) {
  const std::vector<Vec3d> box = scene_with_box(R"("name": "box")")->obstacles[0].mesh.positions;
  for (const Vec3d degrees : triples_of_degrees()) {
    const auto scene = scene_with_box(R"("transform": {"scale": [1, 0.5, 1.5], "rotate": )" +
                                      json(degrees) + R"(, "translate": [3, -2, 1]})");
    const std::vector<Vec3d>& placed = scene->obstacles[0].mesh.positions;
    ASSERT_EQ(placed.size(), box.size());
    for (std::size_t v = 0; v < box.size(); ++v) {
      const Vec3d scaled{box[v].x, 0.5 * box[v].y, 1.5 * box[v].z};
      EXPECT_LE(norm(placed[v] - (turned_in_turn(degrees, scaled) + Vec3d{3, -2, 1})), kTolerance)
          << json(degrees);
    }
  }
}

TEST(Transforms, AnAxisAndAnAngleAreARotationVector) {
  const auto scene =
      scene_with_box(R"("transform": {"rotate": {"axis": [3, 0, 4], "angle": 400}})");
  const auto box = scene_with_box(R"("name": "box")");
  const Mat3<double> rotation = rodrigues(radians(400 * Vec3d{0.6, 0, 0.8}));
  for (std::size_t v = 0; v < box->obstacles[0].mesh.positions.size(); ++v)
    EXPECT_LE(norm(scene->obstacles[0].mesh.positions[v] -
                   rotation * box->obstacles[0].mesh.positions[v]),
              kTolerance);
}

TEST(Transforms, KeyframesOfSeveralAxesAreShortestTurns) {
  for (const Vec3d degrees : triples_of_degrees()) {
    const auto scene =
        scene_with_box(R"("motion": [{"time": 0, "rotate": )" + json(degrees) + "}]");
    const Obstacle& body = scene->obstacles[0];
    const Vec3d rotation = body.motion.at(0).rotation;

    // At the keyframe the body is where the turns put it.
    const std::vector<Vec3d> posed = pose_at(body, 0);
    for (std::size_t v = 0; v < posed.size(); ++v)
      EXPECT_LE(norm(posed[v] - turned_in_turn(degrees, body.mesh.positions[v])), kTolerance)
          << json(degrees);

    // A turn about one axis keeps its full turns, and others are at most half a turn. Half a turn
    // goes the way that makes the largest component of its vector positive.
    if ((degrees.x != 0) + (degrees.y != 0) + (degrees.z != 0) <= 1) {
      EXPECT_EQ(rotation, radians(degrees));
      continue;
    }
    EXPECT_LE(norm(rotation), std::numbers::pi + 1e-6) << json(degrees);
    if (norm(rotation) < std::numbers::pi - 1e-6) continue;
    EXPECT_GT(std::max({rotation.x, rotation.y, rotation.z}), norm_max(rotation) - 1e-6)
        << json(degrees) << " is " << json(rotation);
  }
}

}  // namespace
}  // namespace icloth
