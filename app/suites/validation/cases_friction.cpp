// Coulomb friction of a patch that rests, slides and stops on a plane.
#include <algorithm>
#include <cmath>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/cases.h"
#include "app/suites/validation/strips.h"
#include "sim/scene/shapes.h"

namespace icloth::validation {
namespace {

constexpr double kGravity = 9.81, kThickness = 1e-3;

enum class Ground { obstacle, cloth };

/// A patch of 0.1 m on a level ground that reaches 1 m along x.
struct Patch {
  Ground ground = Ground::obstacle;
  double friction = 0.3;
  double dt = 0.005;
  Index rows = 4;             ///< of triangles in the patch
  double ground_edge = 0.05;  ///< [m]
};

/// A ground of cloth, all of whose vertices are pinned.
Cloth pinned_ground(double edge) {
  const Index rows = static_cast<Index>(std::lround(1.4 / (edge * std::sqrt(0.75))));
  const Strip strip{1.4, rows, static_cast<Index>(std::lround(0.3 / edge))};
  Cloth ground = strip_cloth(
      strip,
      [](double u, double v) {
        return Vec3d{v - 0.3, 0, u};
      },
      plain_fabric(1000, 0.25, 0.2, 1e-5));
  ground.name = "ground";
  for (Index v = 0; v < strip.vertices(); ++v) ground.pins.push_back(v);
  return ground;
}

/// Starts the patch (cloth 0) and lets it come to rest on the ground under gravity across it.
void lay(CaseRun& run, const Patch& patch) {
  auto scene = std::make_shared<Scene>();
  scene->name = scene->source = "patch on a plane";

  Parameters& p = scene->parameters;
  p.wind.air_density = 0;
  p.proximity.thickness = kThickness;
  p.impact_zones.offset = 0.1 * kThickness;
  p.step.time_step = patch.dt;
  p.proximity.friction_obstacle = p.proximity.friction_cloth = patch.friction;
  const Strip strip{0.1, patch.rows, std::max<Index>(1, patch.rows * 9 / 10)};

  // The patch is turned against the edges of the ground, so that pairs change while it slides.
  const double turn = 0.2, c = std::cos(turn), s = std::sin(turn);
  scene->cloths = {strip_cloth(
      strip,
      [&](double u, double v) {
        return Vec3d{c * v - s * u, 0.999 * kThickness, s * v + c * u};
      },
      plain_fabric(1000, 0.25, 0.2, 1e-5))};

  // The ground is a pinned cloth or an obstacle of the same size.
  if (patch.ground == Ground::cloth) {
    scene->cloths.push_back(pinned_ground(patch.ground_edge));
  } else {
    Obstacle ground;
    ground.name = "ground";
    ground.mesh = make_plane(1.4, 0.3, patch.ground_edge);
    for (Vec3d& x : ground.mesh.positions) x.x += 0.4;
    scene->obstacles = {ground};
  }

  run.start(scene);
  run.steps(static_cast<int>(std::lround(0.3 / patch.dt)));
}

/// Turns gravity as if the ground were inclined, falling towards +x.
void incline(CaseRun& run, double tangent) {
  Parameters p = run.parameters();
  const double angle = std::atan(tangent);
  p.gravity.x = kGravity * std::sin(angle);
  p.gravity.y = -kGravity * std::cos(angle);
  run.set_parameters(p);
}

/// The mean position and velocity of the patch along x, weighted by mass.
struct Motion {
  double place = 0, speed = 0;
};

Motion motion(CaseRun& run) {
  const Snapshot state = run.simulator().snapshot();
  const std::vector<double> mass = lumped_mass(run.simulator().scene().cloths[0]);
  Motion sum;
  double total = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    sum.place += mass[i] * state.x1[i].x;
    sum.speed += mass[i] * state.v[i].x;
    total += mass[i];
  }
  return {sum.place / total, sum.speed / total};
}

/// The displacement after `time` on a ground inclined by atan(tangent) [m].
double slide(CaseRun& run, const Patch& patch, double tangent, double time) {
  lay(run, patch);
  const double start = motion(run).place;
  incline(run, tangent);
  run.steps(static_cast<int>(std::lround(time / patch.dt)));
  return motion(run).place - start;
}

/// The displacement of a body under Coulomb friction, as backward Euler with steps dt sums it up
/// (dt = 0: the continuous one).
double coulomb_distance(double tangent, double friction, double time, double dt) {
  const double angle = std::atan(tangent);
  const double a = kGravity * (std::sin(angle) - friction * std::cos(angle));
  return 0.5 * a * time * (time + dt);
}

void threshold(CaseRun& run, Ground ground) {
  const std::vector<double> frictions = run.brief() ? std::vector{0.3} : std::vector{0.1, 0.3, 0.6};
  for (const double friction : frictions) {
    const std::string mu = ", mu = " + number(friction);
    Patch patch;
    patch.ground = ground;
    patch.friction = friction;

    // Just below the threshold the patch must not creep.
    lay(run, patch);
    incline(run, 0.99 * friction);
    run.steps(190);
    const double before = motion(run).place;
    run.steps(10);
    run.bound("creep at 0.99 mu after 1 s [m/s]" + mu, (motion(run).place - before) / 0.05, 1e-4);

    // Just above it, it must slide as fast as the difference of the forces says.
    run.compare("way in 1 s at 1.01 mu [m]" + mu,
                coulomb_distance(1.01 * friction, friction, 1, patch.dt),
                slide(run, patch, 1.01 * friction, 1), 0.25);
  }
}

void sliding(CaseRun& run, Ground ground) {
  const double tangent = std::tan(20 * 3.14159265358979323846 / 180);

  const std::vector<double> frictions = run.brief() ? std::vector{0.3} : std::vector{0.1, 0.2, 0.3};
  for (const double friction : frictions) {
    // Several coefficients are compared with the continuous formula.
    Patch patch;
    patch.ground = ground;
    patch.friction = friction;
    const double time = 0.7;
    run.compare("way at 20 degrees [m], mu = " + number(friction),
                coulomb_distance(tangent, friction, time, 0), slide(run, patch, tangent, time),
                0.01);
  }

  // Several time steps are compared with the formula of backward Euler.
  Patch patch;
  patch.ground = ground;
  for (const int rate : {50, 100, 400}) {
    if (run.brief() && rate == 400) continue;
    patch.dt = 1.0 / rate;
    run.compare("the same of backward Euler, dt = 1/" + std::to_string(rate),
                coulomb_distance(tangent, 0.3, 0.6, patch.dt), slide(run, patch, tangent, 0.6),
                0.01);
  }

  // The result must not depend on the meshes of the patch and of the ground.
  patch.dt = 0.005;
  for (const Index rows : {2, 8, 16}) {
    if (run.brief() && rows == 16) continue;
    patch.rows = rows;
    patch.ground_edge = rows == 2 ? 0.3 : 0.02;
    run.compare("the same with " + std::to_string(rows) + " rows of triangles",
                coulomb_distance(tangent, 0.3, 0.6, patch.dt), slide(run, patch, tangent, 0.6),
                0.01);
  }
}

void stopping(CaseRun& run, Ground ground) {
  for (const double speed : {0.5, 1.5}) {
    // The patch lies at rest and is then thrown.
    Patch patch;
    patch.ground = ground;
    lay(run, patch);
    const double start = motion(run).place;
    Snapshot state = run.simulator().snapshot();
    const std::size_t count = run.simulator().scene().cloths[0].mesh.positions.size();
    for (std::size_t i = 0; i < count; ++i) state.v[i].x += speed;
    run.simulator().restore(state);

    // Backward Euler applies the friction of a step to the velocity before the displacement.
    double distance = 0;
    for (double v = speed - 0.3 * kGravity * patch.dt; v > 0; v -= 0.3 * kGravity * patch.dt)
      distance += v * patch.dt;
    run.steps(static_cast<int>(1.2 * speed / (0.3 * kGravity * patch.dt)));
    run.compare("stopping way from " + number(speed) + " m/s [m]", distance,
                motion(run).place - start, 0.01);
    run.bound("speed then [m/s]", motion(run).speed, 1e-4);
  }
}

}  // namespace

/// A patch of cloth on an inclined ground, an obstacle or a pinned cloth. Source: Coulomb's law
/// with equal static and kinetic coefficients, at rest iff tan α ≤ μ. Protocol: the patch settles
/// on the level ground, then gravity turns at once. Measured are the mean speed after 1 s at tan α
/// = 0.99 μ, and the displacement in 1 s at 1.01 μ (1 % of the friction decides all of it, hence
/// the wide target).
void threshold_on_body(CaseRun& run) { threshold(run, Ground::obstacle); }
void threshold_on_cloth(CaseRun& run) { threshold(run, Ground::cloth); }

/// The same patch slides. Source: x = ½ g (sin α − μ cos α) t², of which backward Euler makes ½ a t
/// (t + dt). Protocol: 20°, dt = 1/200 s against the continuous formula; steps from 1/50 to 1/400 s
/// and meshes from 2 to 16 rows (and other edges of the ground) against the discrete one.
void sliding_on_body(CaseRun& run) { sliding(run, Ground::obstacle); }
void sliding_on_cloth(CaseRun& run) { sliding(run, Ground::cloth); }

/// The patch is thrown along the level ground. Source: v0²/(2 μ g), as backward Euler sums it up, Σ
/// v_n dt with v_n = v0 − n μ g dt; then it rests.
void stopping_on_body(CaseRun& run) { stopping(run, Ground::obstacle); }
void stopping_on_cloth(CaseRun& run) { stopping(run, Ground::cloth); }

}  // namespace icloth::validation
