// Friction against elasticity: a pressed strip that slips, and a belt that slides over a cylinder.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/cases.h"
#include "app/suites/validation/references.h"
#include "app/suites/validation/strips.h"
#include "sim/scene/shapes.h"

namespace icloth::validation {
namespace {

constexpr double kGravity = 9.81, kPi = std::numbers::pi;

constexpr double kFirstShortening = 0.01, kLastShortening = 0.32, kLastTime = 3.3;

/// A weightless strip clamped upright at its upper end, already buckled a little, above a ground
/// that rises slowly after 0.3 s. The friction is 1 to begin with.
std::shared_ptr<Scene> pressed_strip(const Strip& strip, double last_shortening) {
  const double modulus = 1e-5, row = strip.row_height(), length = strip.length - 0.5 * row;
  auto scene = exact_scene("pressed strip");

  // Contacts have to be resolved far below the displacements that are measured.
  Parameters& p = scene->parameters;
  p.proximity.enabled = true;
  p.step.max_substep_levels = 6;
  p.implicit.contact_passes = 100;
  p.implicit.cg_tolerance = 1e-5;
  p.proximity.thickness = 5e-4;
  p.impact_zones.offset = 5e-5;
  p.proximity.friction_obstacle = 1;
  p.gravity.y = 0;

  // The strip starts in the shape of the elastica with a small shortening.
  const PressedElastica start = pressed_elastica(kFirstShortening);
  scene->cloths = {strip_cloth(
      strip,
      [&](double u, double v) {
        const double s = (v - 0.5 * row) / length;
        const auto [across, along] = s < 0 ? std::array{0.0, s} : pressed_point(start, s);
        return Vec3d{length * across,
                     length * (1 - kFirstShortening - along) + p.proximity.thickness, u};
      },
      plain_fabric(1000, 0, 0.02, modulus))};
  pin_row(scene->cloths[0], strip, 0);
  pin_row(scene->cloths[0], strip, 1);

  // The ground rests, then rises to the last shortening.
  Obstacle ground;
  ground.name = "ground";
  ground.mesh = make_plane(0.2, 0.05, 0.05);
  const double rise = (last_shortening - kFirstShortening) * length;
  ground.motion = {{0, {0, 0, 0}, {}}, {0.3, {0, 0, 0}, {}}, {kLastTime, {0, rise, 0}, {}}};
  scene->obstacles = {ground};
  return scene;
}

/// The shortening, in lengths, at which the tip has moved by 5·10⁻⁴ lengths, or the last one when
/// it has not moved until then.
double first_slip(CaseRun& run, double friction, double last_shortening) {
  const Strip strip{0.1, 40, 2};
  const double length = strip.length - 0.5 * strip.row_height();
  run.start(pressed_strip(strip, last_shortening));
  const double clamp =
      0.5 * (row_mean(strip, run.positions(), 0).y + row_mean(strip, run.positions(), 1).y);

  // The strip settles with much friction, then with the one to be tested.
  run.steps(20);
  Parameters p = run.parameters();
  p.proximity.friction_obstacle = friction;
  run.set_parameters(p);
  run.steps(16);
  const double stuck = row_mean(strip, run.positions(), strip.rows).x;

  // The ground rises until the tip slips.
  double shortening = 0;
  while (run.simulator().time() < kLastTime) {
    run.step();
    const Vec3d tip = row_mean(strip, run.positions(), strip.rows);
    shortening = 1 - (clamp - tip.y) / length;
    if (std::fabs(tip.x - stuck) > 5e-4 * length) break;
  }
  return shortening;
}

/// The shortening at which a friction coefficient is just enough, by bisection.
double slip_shortening(double friction) {
  double low = 1e-3, high = 0.33;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    (pressed_elastica(middle).friction() < friction ? low : high) = middle;
  }
  return low;
}

constexpr double kCylinder = 0.02, kBeltThickness = 1e-3, kBelt = kCylinder + kBeltThickness;

/// A cylinder along z without its ends.
TriangleMesh open_cylinder(double radius, double width, Index sides, Index cells) {
  TriangleMesh mesh;
  for (Index j = 0; j <= cells; ++j)
    for (Index i = 0; i < sides; ++i) {
      const double angle = 2 * kPi * i / sides;
      mesh.positions.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), width * (1.0 * j / cells - 0.5)});
    }

  // Each cell of the lattice becomes two triangles that face outwards.
  for (Index j = 0; j < cells; ++j)
    for (Index i = 0; i < sides; ++i) {
      const Index a = j * sides + i, b = j * sides + (i + 1) % sides, c = a + sides, d = b + sides;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

/// A strip over a cylinder, with legs of two lengths hanging down.
std::shared_ptr<Scene> belt_scene(const Strip& strip, double light_leg) {
  auto scene = std::make_shared<Scene>();
  scene->name = scene->source = "belt";

  Parameters& p = scene->parameters;
  p.wind.air_density = 0;
  p.proximity.thickness = kBeltThickness;
  p.impact_zones.offset = 0.1 * kBeltThickness;
  p.step.time_step = 0.005;
  p.implicit.contact_passes = 100;
  p.proximity.friction_obstacle = 2;  // until it hangs at rest

  // The belt starts around the cylinder at the distance of the thickness.
  const double arc = kPi * kBelt;
  scene->cloths = {strip_cloth(
      strip,
      [&](double u, double v) {
        const double s = v - light_leg, angle = s / kBelt;
        if (s < 0) return Vec3d{-kBelt, s, u};
        if (s > arc) return Vec3d{kBelt, arc - s, u};
        return Vec3d{-kBelt * std::cos(angle), kBelt * std::sin(angle), u};
      },
      plain_fabric(1000, 0, 0.2, 0))};

  // The cylinder is wider than the belt.
  Obstacle cylinder;
  cylinder.name = "cylinder";
  cylinder.mesh = open_cylinder(kCylinder, 0.03, 90, 3);
  scene->obstacles = {cylinder};
  return scene;
}

/// The length of cloth that hangs from the light side, found by the place of the cloth at the top.
double light_leg_now(CaseRun& run, const Strip& strip) {
  const std::vector<Vec3d> x = run.positions();
  for (Index r = 0; r < strip.rows; ++r) {
    const double here = row_mean(strip, x, r).x, next = row_mean(strip, x, r + 1).x;
    if (here < 0 && next >= 0)
      return (r - here / (next - here)) * strip.row_height() - 0.5 * kPi * kBelt;
  }
  throw std::runtime_error("the belt has slid off");
}

/// The friction at which the belt begins to slide, when it falls by half a per cent every 0.1 s.
double sliding_friction(CaseRun& run, const Strip& strip, double expected) {
  Parameters p = run.parameters();
  for (double share = 1.05; share > 0.85; share -= 0.005) {
    p.proximity.friction_obstacle = share * expected;
    run.set_parameters(p);
    if (share == 1.05) run.steps(40);
    const double before = light_leg_now(run, strip);
    run.steps(20);
    if (before - light_leg_now(run, strip) > 5e-5) break;
  }
  return p.proximity.friction_obstacle;
}

}  // namespace

/// A weightless strip, clamped upright, stands on a rough ground that rises slowly. It buckles, and
/// its tip slips when the ground cannot hold it. Source: the elastica with a hinged end straight
/// below the clamp (after Sano, Yamaguchi, Wada 2017; Romero et al. 2021, test 4). The friction
/// |Q|/P that it needs grows with the shortening; above 0.3564 it lies down and does not slip.
/// Protocol: 40 rows, shortening at which the tip has moved by 5·10⁻⁴ L.
void stick_slip(CaseRun& run) {
  const std::vector<double> frictions = run.brief() ? std::vector{0.2} : std::vector{0.1, 0.2, 0.3};
  for (const double friction : frictions) {
    const double expected = slip_shortening(friction);
    run.compare("shortening at first slip, mu = " + number(friction), expected,
                first_slip(run, friction, 1.2 * expected), 0.05);
  }

  // With enough friction the strip must not slip at all.
  if (run.brief()) return;
  const double reached = first_slip(run, 0.4, kLastShortening);
  run.require(reached > 0.99 * kLastShortening, "mu = 0.4: no slip, but did at " + number(reached));
}

/// A belt hangs over a half cylinder with legs of two lengths. Source: Euler and Eytelwein, it
/// slips iff T2/T1 > exp(μπ), here with the weight of the belt itself on the cylinder. Protocol: it
/// hangs at rest with μ = 2, then μ falls slowly. T2/T1 of the legs is compared with the ratio that
/// holds at the μ at which the belt moves by 0.05 mm in 0.1 s.
void belt(CaseRun& run) {
  const std::vector<double> frictions = run.brief() ? std::vector{0.3} : std::vector{0.1, 0.3, 0.5};
  for (const double friction : frictions) {
    // The legs are laid out for the friction that shall let the belt slide.
    const double row = 0.004, light = 0.1;
    Strip strip;
    strip.columns = 2;
    strip.rows = static_cast<Index>(
        std::lround((light + kPi * kBelt + belt_leg(friction, light, kBelt)) / row));
    strip.length = strip.rows * row;

    run.start(belt_scene(strip, light));
    run.steps(80);

    // The lengths are those after it has come to rest.
    const double leg = light_leg_now(run, strip), heavy = strip.length - leg - kPi * kBelt;
    const double slid = sliding_friction(run, strip, belt_friction(leg, heavy, kBelt));
    run.compare("T2/T1 that just slides, mu = " + number(slid).substr(0, 5),
                belt_leg(slid, leg, kBelt) / leg, heavy / leg, 0.02);
  }
}

}  // namespace icloth::validation
