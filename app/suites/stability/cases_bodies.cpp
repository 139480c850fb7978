// Cloth against obstacles.
#include <cmath>
#include <limits>
#include <numbers>

#include "app/suites/stability/case_run.h"
#include "app/suites/stability/cases.h"
#include "app/suites/stability/scenes.h"
#include "sim/scene/transforms.h"

namespace icloth::stability {
namespace {

/// A sheet that hangs in the xy plane, and a ball that moves along z from one time to another.
std::shared_ptr<Scene> ball_through_sheet(const char* name, bool pinned, double start, double end,
                                          double height) {
  auto scene = new_scene(name, 0.03);
  const GridShape shape = square(0.4, 400, false);
  scene->cloths = {make_cloth(shape, {0.003, 0, 0.001})};
  if (pinned) pin(scene->cloths[0], shape, "top");
  scene->obstacles = {make_body(make_sphere(0.1, 320), {})};
  scene->obstacles[0].motion = {{start, {0, height, -0.5}, {}}, {end, {0, height, 1.5}, {}}};
  return scene;
}

/// A lying sheet between two boxes. Their distance is `closest` at half a second, and larger later.
std::shared_ptr<Scene> closing_boxes(const char* name, double closest) {
  auto scene = new_scene(name, 0.02);
  scene->parameters.gravity.y = 0;

  scene->cloths = {lying_sheet(0.15, 150, {})};
  for (const double side : {-1.0, 1.0}) {
    scene->obstacles.push_back(make_body(make_box({0.25, 0.02, 0.25}, 0.05), {}));
    const auto away = [&](double gap) { return Vec3d{0, side * (0.01 + gap / 2), 0}; };
    scene->obstacles.back().motion = {
        {0, away(0.03), {}}, {0.5, away(closest), {}}, {1.0, away(0.03), {}}};
  }
  return scene;
}

/// A strip over a cylinder along z, whose legs of two lengths hang down.
std::shared_ptr<Scene> belt_scene(double left, double right) {
  constexpr double kRadius = 0.05, kEdge = 0.01, kArc = std::numbers::pi * 0.053;
  auto scene = new_scene("belt", kEdge);

  const double length = left + kArc + right, bend = kRadius + 3e-3;
  const auto columns = static_cast<Index>(std::lround(length / kEdge));

  // The strip follows the cylinder from one leg to the other.
  std::vector<Vec3d> positions, flat;
  std::vector<Triangle> faces;
  for (Index j = 0; j <= 3; ++j)
    for (Index i = 0; i <= columns; ++i) {
      const double s = length * i / columns - left, angle = s / bend, z = kEdge * (1.5 - j);
      const Vec3d place = s < 0      ? Vec3d{-bend, s, z}
                          : s > kArc ? Vec3d{bend, kArc - s, z}
                                     : Vec3d{-bend * std::cos(angle), bend * std::sin(angle), z};
      positions.push_back(place);
      flat.push_back({s, 0, z});
    }
  for (Index j = 0; j < 3; ++j)
    for (Index i = 0; i < columns; ++i) {
      const Index a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = a + columns + 1;
      faces.insert(faces.end(), {{a, d, c}, {a, c, b}});
    }

  // It was cut flat, and hardly stretches or bends.
  Cloth strip = cloth_of(std::move(positions), std::move(faces));
  strip.rest = std::move(flat);
  strip.material = uniform_fabric(1e3, 0.2, 1e-6);
  scene->cloths = {std::move(strip)};

  // The cylinder is a capsule, turned until its axis lies along z.
  TriangleMesh cylinder = make_capsule(kRadius, 0.1, 3000);
  for (Vec3d& p : cylinder.positions) p = {p.y, p.z, p.x};
  for (Vec3d& p : cylinder.positions) p = {p.y, p.z, p.x};
  scene->obstacles = {make_body(std::move(cylinder), {})};

  scene->parameters.proximity.friction_obstacle = 0.3;
  scene->parameters.step.time_step = 0.005;
  return scene;
}

}  // namespace

void tunnelling_ball(CaseRun& run) {
  auto scene = ball_through_sheet("ball at 30 m/s", false, 0, 2.0 / 30, 0);
  scene->parameters.step.time_step = 0.02;
  run.start(scene);
  run.run_for(run.brief() ? 0.1 : 0.3);
}

void needle(CaseRun& run) {
  auto scene = new_scene("sheet on a needle", 0.03);
  scene->cloths = {lying_sheet(0.3, 200, {0.007, 0.02, 0.004})};
  scene->obstacles = {make_body(make_spike(0.004, 0.3, 8), {})};
  run.start(scene);
  run.run_for(run.brief() ? 0.3 : 1.0);
}

void box_corner(CaseRun& run) {
  auto scene = new_scene("sheet on a corner", 0.03);
  TriangleMesh box = make_box({0.2, 0.2, 0.2}, 0.2);

  // The space diagonal points up.
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(std::acos(1 / std::numbers::sqrt3), Eigen::Vector3d(-1, 0, 1).normalized())
          .toRotationMatrix();
  for (Vec3d& p : box.positions) p = from_eigen(turn * to_eigen(p));

  scene->obstacles = {make_body(box, {})};
  scene->cloths = {lying_sheet(0.4, run.brief() ? 200 : 800, {0.013, 0.2, -0.006})};
  run.start(scene);
  run.run_for(run.brief() ? 0.3 : 1.0);
}

void narrow_gap(CaseRun& run) {
  // There is room for the sheet, but less than its thickness on each side.
  auto scene = closing_boxes("narrow gap", 0);
  run.start(closing_boxes("narrow gap", 5 * scene->parameters.impact_zones.offset));
  run.run_for(1.0);
}

void pinch(CaseRun& run) {
  // Between bodies that overlap the cloth lies in one of them: it is checked when they are apart.
  run.start(closing_boxes("pinch", -0.005));
  run.check_every(std::numeric_limits<int>::max());
  run.require(run.run_for(1.0), "no step is refused while the boxes overlap");
  run.check_every(1);
  run.run_for(0.2);
}

void pin_in_the_way(CaseRun& run) {
  run.allow_refusals();
  run.start(ball_through_sheet("ball through pins", true, 0, 1, 0.2));
  run.require(!run.run_for(1.0), "the step without a solution is refused");
}

void teleport(CaseRun& run) {
  run.allow_refusals();
  auto scene = ball_through_sheet("ball jumps across", true, 0.1, 0.101, -0.05);
  scene->obstacles[0].motion.push_back({0.2, {0, -0.05, 1.5}, {}});
  scene->obstacles[0].motion.push_back({0.2005, {0, -0.05, -0.5}, {}});
  run.start(scene);
  if (!run.run_for(run.brief() ? 0.3 : 0.5)) run.note("refused");
}

void skirt(CaseRun& run) {
  constexpr double kPi = std::numbers::pi;
  auto scene = new_scene("skirt on a swinging body", 0.02);
  scene->parameters.step.time_step = 0.05;

  // A skirt hangs around a capsule and is pinned at its upper rim.
  scene->cloths = {make_tube(0.155, 0.38, 0.5, run.brief() ? 1000 : 4000)};
  scene->obstacles = {make_body(make_capsule(0.12, 0.6, 600), {0, -0.25, 0})};

  // Hips turn and swing about the waist.
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.05 * k, ramp = std::fmin(1, t);
    scene->obstacles[0].motion.push_back(
        {t,
         {},
         {0.25 * ramp * std::sin(2 * kPi * 0.7 * t), 0.8 * ramp * std::sin(2 * kPi * t),
          0.45 * ramp * std::sin(2 * kPi * t)}});
  }

  run.start(scene);
  run.run_for(run.brief() ? 1.0 : 5.0);
}

void belt(CaseRun& run) {
  // By Euler and Eytelwein exp(0.3 π) = 2.57, so legs of 1 : 1.5 hold and legs of 1 : 5 do not.
  const auto slide = [&](double left, double right) {
    run.start(belt_scene(left, right));
    run.steps(10);
    const double before = run.positions().front().y;
    run.run_for(0.3);
    return run.positions().front().y - before;
  };

  const double held = slide(0.3, 0.45), slipped = slide(0.15, 0.75);
  run.require(std::fabs(held) < 0.02, "legs of 1 : 1.5 hold");
  run.require(slipped > 0.05, "legs of 1 : 5 slide");
  run.note("moved " + std::to_string(held) + " and " + std::to_string(slipped) + " m");
}

}  // namespace icloth::stability
