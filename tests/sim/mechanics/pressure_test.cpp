// Pressure inside closed cloth: its kernel against the volume (double build), and whole runs.
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include "sim/mechanics/pressure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "kernels/index.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth::cpu64 {
namespace {

constexpr double kYoung = 1000, kPoisson = 0.3;  // of an isotropic fabric [N/m], -

Cloth make_balloon(double radius, Index triangles) {
  Cloth cloth;
  cloth.name = "balloon";
  cloth.mesh = make_sphere(radius, triangles);
  cloth.rest = cloth.mesh.positions;
  set_orthotropic(cloth.material, {.young_u = kYoung,
                                   .young_v = kYoung,
                                   .poisson = kPoisson,
                                   .shear = kYoung / (2 * (1 + kPoisson))});
  return cloth;
}

void turn_inside_out(Cloth& cloth) {
  for (Triangle& t : cloth.mesh.faces) std::swap(t[1], t[2]);
}

std::shared_ptr<Scene> weightless(Cloth cloth) {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->parameters.wind.air_density = 0;
  scene->parameters.gravity.y = 0;
  scene->parameters.implicit.cg_tolerance = 1e-6;
  scene->cloths.push_back(std::move(cloth));
  return scene;
}

template <class Point>
double volume_of(const std::vector<Triangle>& faces, const std::vector<Point>& x) {
  double sum = 0;
  for (const Triangle& t : faces)
    sum += dot(convert<double>(x[at(t[0])]),
               cross(convert<double>(x[at(t[1])]), convert<double>(x[at(t[2])])));
  return std::fabs(sum) / 6;
}

double volume_of(const Simulator& simulator) {
  std::vector<Vec3f> x;
  simulator.positions(x);
  return volume_of(simulator.scene().cloths[0].mesh.faces, x);
}

TEST(Pressure, KnowsClosedSurfacesAndTheirOutside) {
  Cloth inside_out = make_balloon(0.1, 80);
  turn_inside_out(inside_out);
  Scene scene;
  scene.cloths = {make_balloon(0.1, 80), inside_out, make_balloon(0.1, 80),
                  testing::make_sheet(testing::lying(0.3, 8), {})};
  scene.cloths[2].mesh.faces.pop_back();  // a hole
  const World world = make_world(scene);
  const std::vector<Real> outward = outward_sides(world);
  const Real expected[] = {1, -1, 0, 0};
  for (Index f = 0; f < world.cloth_faces; ++f)
    EXPECT_EQ(outward[at(f)], expected[world.face_material[at(f)]]) << f;
}

TEST(Pressure, PushesAlongTheGradientOfTheVolume) {
  // One vertex of a small closed surface is moved; all faces around it push it by p ∂V/∂x.
  const TriangleMesh mesh = make_sphere(0.1, 80);
  const double pressure = 30, dt = 0.01, step = 1e-6;
  Vec3d impulse, slope;
  for (const Triangle& t : mesh.faces)
    for (int a = 0; a < 3; ++a) {
      if (t[static_cast<std::size_t>(a)] != 0) continue;
      const Fabric fabric{};
      FaceShape shape{.index = 0,
                      .v = {},
                      .fabric = fabric,
                      .inverse = nullptr,
                      .area = 0,
                      .at = {},
                      .velocity = {},
                      .frame = {},
                      .strain = {}};
      for (int b = 0; b < 3; ++b) shape.at[b] = mesh.positions[at(t[at(b)])];
      const Real outward = 1;
      FaceTerm term{};
      PressureShare{{&outward, 1}, pressure, dt}.add(shape, term);
      impulse += term.impulse[a];
    }
  for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
    std::vector<Vec3d> plus = mesh.positions, minus = mesh.positions;
    plus[0].*axis += step;
    minus[0].*axis -= step;
    slope.*axis = (volume_of(mesh.faces, plus) - volume_of(mesh.faces, minus)) / (2 * step);
  }
  EXPECT_GT(norm(impulse), 0);
  EXPECT_LT(norm(impulse - dt * pressure * slope), 1e-6 * norm(impulse));
}

TEST(Pressure, InflatesABalloonToTheAnalyticSize) {
  // A surface that grows by λ in all directions has the energy A₀ (k11 + k12) (λ² − 1)²/4 of an
  // isotropic fabric, k11 + k12 = E/(1 − ν); in equilibrium its slope is that of p V₀ λ³.
  const double stretch = 1.05;
  for (const bool inside_out : {false, true}) {
    Cloth balloon = make_balloon(0.1, 500);
    if (inside_out) turn_inside_out(balloon);
    const double volume = volume_of(balloon.mesh.faces, balloon.mesh.positions);
    const auto scene = weightless(std::move(balloon));
    double area = 0;
    for (const double a : make_world(*scene).face_area) area += a;
    scene->parameters.material.pressure =
        kYoung / (1 - kPoisson) * (stretch * stretch - 1) * area / (3 * volume * stretch);
    scene->parameters.material.damping = 0.01;

    const auto simulator = make_simulator(Build::cpu64, scene);
    StepReport report;
    for (int k = 0; k < 40; ++k) {
      report = simulator->step({});
      ASSERT_TRUE(report.accepted) << k;
    }
    EXPECT_LT(report.max_speed, 1e-3);
    EXPECT_NEAR(std::cbrt(volume_of(*simulator) / volume), stretch, 0.02 * (stretch - 1));
  }
}

TEST(Pressure, MovesAClosedBodyNowhere) {
  // A lopsided body far from the origin: its centre of mass stays, and no energy is made.
  Cloth body = make_balloon(0.1, 320);
  for (Vec3d& p : body.mesh.positions) p = {2 + p.x * (1 + 3 * p.x), 1 + 0.7 * p.y, p.z};
  body.rest = body.mesh.positions;
  const auto scene = weightless(std::move(body));
  scene->parameters.material.pressure = 500;
  const World world = make_world(*scene);
  const auto centre = [&](const Simulator& simulator) {
    std::vector<Vec3f> x;
    simulator.positions(x);
    Vec3d sum;
    double mass = 0;
    for (std::size_t i = 0; i < world.mass.size(); ++i) {
      sum += world.mass[i] * convert<double>(x[i]);
      mass += world.mass[i];
    }
    return (1 / mass) * sum;
  };

  const auto simulator = make_simulator(Build::cpu64, scene);
  const Vec3d start = centre(*simulator);
  const double volume = volume_of(*simulator);
  for (int k = 0; k < 20; ++k) {
    const StepReport report = simulator->step({});
    ASSERT_TRUE(report.accepted) << k;
    EXPECT_LT(report.energy_balance, 1e-3 * scene->parameters.material.pressure * volume) << k;
  }
  EXPECT_GT(volume_of(*simulator), 1.01 * volume);
  EXPECT_LT(norm(centre(*simulator) - start), 1e-6);
}

TEST(Pressure, InflatesTheClothOfASceneFile) {
  const auto scene = load_scene(std::string(ICLOTH_TEST_FOLDER) + "/data/balloon.json", {});
  const auto simulator = make_simulator(Build::cpu64, scene);
  const double volume = volume_of(*simulator);
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(simulator->step({}).accepted) << k;
  EXPECT_GT(volume_of(*simulator), 1.01 * volume);
}

TEST(Pressure, LeavesOpenClothAlone) {
  std::uint64_t hash[2];
  for (const int k : {0, 1}) {
    const auto scene = weightless(testing::make_sheet(testing::lying(0.3, 100), {}));
    scene->parameters.gravity.y = -9.81;
    scene->parameters.material.pressure = k * 1000.0;
    const auto simulator = make_simulator(Build::cpu64, scene);
    for (int step = 0; step < 5; ++step) simulator->step({});
    hash[k] = simulator->state_hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace icloth::cpu64
