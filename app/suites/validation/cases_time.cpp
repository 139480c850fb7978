// Time integration: the exact effect of backward Euler on motions that can be written down.
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/cases.h"
#include "app/suites/validation/strips.h"

namespace icloth::validation {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;

Vec3d flat(double u, double v) { return {u, v, 0}; }

/// Two equilateral triangles, three of whose four vertices are pinned. The free one is vertex 0.
struct Tip {
  Cloth cloth;
  double height, area;
};

Tip one_free_vertex(const Material& material) {
  const double edge = 0.1, height = edge * std::sqrt(0.75);
  Tip tip;
  tip.height = height;
  tip.area = 0.5 * edge * height;
  tip.cloth.name = "tip";
  tip.cloth.material = material;
  tip.cloth.mesh.positions = {{0, height, 0}, {-edge / 2, 0, 0}, {edge / 2, 0, 0}, {0, -height, 0}};
  tip.cloth.mesh.faces = {{1, 2, 0}, {2, 1, 3}};

  for (const Triangle& t : tip.cloth.mesh.faces) {
    const auto uv = [&](std::size_t k) {
      const Vec3d p = tip.cloth.mesh.positions[static_cast<std::size_t>(t[k])];
      return Vec2d{p.x, p.y};
    };
    tip.cloth.mesh.uv.push_back({uv(0), uv(1), uv(2)});
  }

  // Only vertex 0 can move.
  tip.cloth.rest = tip.cloth.mesh.positions;
  tip.cloth.pins = {1, 2, 3};
  return tip;
}

/// Releases the free vertex at rest from a small displacement and follows z = x + i v/ω, which
/// backward Euler divides by 1 + iω dt in every step.
void follow(CaseRun& run, const Tip& tip, const char* what, Vec3d direction, double omega) {
  auto scene = exact_scene("oscillator");
  scene->parameters.gravity.y = 0;
  scene->parameters.step.time_step = 0.2 / omega;
  scene->cloths = {tip.cloth};
  run.start(scene);

  // The vertex starts at rest, displaced in the direction of the motion.
  std::vector<Vec3d> x = run.positions();
  const Vec3d rest = x[0];
  const double displacement = 1e-7 * tip.height;
  x[0] += displacement * direction;
  run.set_state(x, {});

  const int count = 40;
  run.steps(count);

  // Displacement and velocity are the parts of z.
  const Snapshot state = run.simulator().snapshot();
  const Complex z(dot(state.x1[0] - rest, direction) / displacement,
                  dot(state.v[0], direction) / (omega * displacement));

  // The product of all steps has a known size and argument.
  const double dt = scene->parameters.step.time_step, turned = count * std::atan(omega * dt);
  const double off = std::arg(z * std::polar(1.0, turned));
  run.compare(std::string(what) + ": amplitude ratio", 1 / std::sqrt(1 + std::pow(omega * dt, 2)),
              std::pow(std::abs(z), 1.0 / count), 1e-5);
  run.compare(std::string(what) + ": phase a step", turned / count, (turned - off) / count, 1e-5);
}

/// A sheet with constant coefficients, a tenth of a metre wide.
Cloth small_sheet(double modulus) {
  const Strip strip{0.1, 8, 8};
  return strip_cloth(strip, flat, plain_fabric(50, 0.25, 0.2, modulus));
}

/// A stretched, sheared and bent shape, with a smooth velocity and a turn.
void deform(const std::vector<Vec3d>& rest, std::vector<Vec3d>& x, std::vector<Vec3d>& v) {
  x.clear(), v.clear();
  for (const Vec3d p : rest) {
    x.push_back({1.06 * p.x + 0.03 * p.y, 1.02 * p.y, 0.01 * std::sin(40 * p.x + 25 * p.y)});
    v.push_back({0.3 + 0.4 * std::sin(50 * p.y), -0.2 - 3 * p.z, 0.5 * std::cos(30 * p.x) + p.y});
  }
}

/// The errors of time steps dt, dt/2 and dt/4 against dt/16, as mass-weighted mean squares over all
/// vertices. The scene is a flag pinned along its upper edge, let go level, for 0.08 s, of a soft
/// fabric whose waves steps of 1/400 s resolve.
void errors_of_steps(CaseRun& run, Integrator integrator, double error[3]) {
  const Strip strip{0.1, 8, 6};
  const Cloth sheet = strip_cloth(
      strip,
      [](double u, double v) {
        return Vec3d{u, 0, v};
      },
      plain_fabric(5, 0.25, 0.2, 2e-5));

  // A run with one step gives the positions at the end.
  const auto end_state = [&](double dt) {
    auto scene = exact_scene("order in dt");
    scene->parameters.step.time_step = dt;
    scene->parameters.implicit.integrator = integrator;
    scene->cloths = {sheet};
    pin_row(scene->cloths[0], strip, 0);
    run.start(scene);
    run.steps(static_cast<int>(std::lround(0.08 / dt)));
    return run.positions();
  };

  const double dt = 0.0025;
  const std::vector<double> mass = lumped_mass(sheet);
  const std::vector<Vec3d> fine = end_state(dt / 16);

  // The finest run stands for the exact solution.
  for (int n = 0; n < 3; ++n) {
    const std::vector<Vec3d> x = end_state(dt / (1 << n));
    double sum = 0;
    for (std::size_t i = 0; i < mass.size(); ++i) sum += mass[i] * norm2(x[i] - fine[i]);
    error[n] = std::sqrt(sum);
  }
}

}  // namespace

/// A free sheet is thrown. Source: backward Euler applied to ẍ = g, in closed form x_n = x0 + v0 t
/// + ½ g t (t + dt), v_n = v0 + g t. Protocol: 20 steps of 1/100 s, largest error of all vertices
/// against the displacement from the start.
void free_fall(CaseRun& run) {
  const Vec3d thrown{1, 2, -0.5}, g{0.5, -9.81, 0.25};

  auto scene = exact_scene("free fall");
  scene->parameters.gravity.x = g.x, scene->parameters.gravity.z = g.z;
  scene->cloths = {small_sheet(1e-5)};
  run.start(scene);

  // The sheet is thrown and falls.
  const std::vector<Vec3d> start = run.positions();
  run.set_state(start, std::vector<Vec3d>(start.size(), thrown));

  const int count = 20;
  run.steps(count);
  const Snapshot state = run.simulator().snapshot();

  // Every vertex must have the displacement and the velocity of the formula.
  const double dt = scene->parameters.step.time_step, t = count * dt;
  const Vec3d displacement = t * thrown + (0.5 * t * (t + dt)) * g, speed = thrown + t * g;
  double position_error = 0, speed_error = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    position_error = std::max(position_error, norm(state.x1[i] - start[i] - displacement));
    speed_error = std::max(speed_error, norm(state.v[i] - speed));
  }
  run.bound("position, of the way", position_error / norm(displacement), 1e-5);
  run.bound("velocity, of the speed", speed_error / norm(speed), 1e-5);
}

/// One free vertex swings along, across and out of two triangles. Source: backward Euler applied to
/// ẍ + ω² x = 0: each step multiplies the amplitude by 1/√(1 + ω²dt²) and turns the phase by atan(ω
/// dt). With height h, area A and mass m = ρA/3, ω² is k22 A/(h² m) along, ½ k33 A/(h² m) across
/// and K/(h² m) out of the plane. K = 2 · 1.2 D A/l² is the stiffness of two faces about their
/// hinge: an angle θ is the curvature tensor of size √1.2 θ/l, the smallest that has it.
void oscillator(CaseRun& run) {
  const double density = 0.2, tensile = 40, poisson = 0.25, modulus = 1e-5;
  const Tip tip = one_free_vertex(plain_fabric(tensile, poisson, density, modulus));

  // Each of the three motions has a stiffness of its own.
  const double h2m = tip.height * tip.height * density * tip.area / 3;
  const double k22 = tensile / (1 - poisson * poisson), k33 = tensile / (1 + poisson);
  const double hinge = 2.4 * modulus * tip.area / std::pow(0.1, 2);

  follow(run, tip, "stretch", {0, 1, 0}, std::sqrt(k22 * tip.area / h2m));
  follow(run, tip, "shear", {1, 0, 0}, std::sqrt(0.5 * k33 * tip.area / h2m));
  follow(run, tip, "bending", {0, 0, 1}, std::sqrt(hinge / h2m));
}

/// A free sheet without gravity is deformed and thrown. Source: internal forces add up to no force
/// and to no torque about the positions at which they act. Backward Euler evaluates them at the
/// end, so Σ m Δv = 0 and Σ x1 × m Δv = 0 in every step, up to the CG tolerance. (The angular
/// momentum itself, Σ x × m v, is kept to first order in dt only, as with any backward Euler.)
void momentum(CaseRun& run) {
  auto scene = exact_scene("momentum");
  scene->parameters.gravity.y = 0;
  scene->cloths = {small_sheet(1e-5)};
  run.start(scene);

  const std::vector<double> mass = lumped_mass(scene->cloths[0]);
  std::vector<Vec3d> x, v;
  deform(scene->cloths[0].rest, x, v);
  run.set_state(x, v);

  // The sums are compared with the sums of the sizes, step by step.
  double linear = 0, angular = 0;
  for (int k = 0; k < 20; ++k) {
    const Snapshot before = run.simulator().snapshot();
    run.step();
    const Snapshot after = run.simulator().snapshot();

    Vec3d impulse, torque;
    double size = 0, turn = 0;

    // Torques act about the end positions.
    for (std::size_t i = 0; i < mass.size(); ++i) {
      const Vec3d change = mass[i] * (after.v[i] - before.v[i]);
      const Vec3d arm = after.x1[i] - after.x1[0];
      impulse += change;
      torque += cross(arm, change);
      size += norm(change);
      turn += norm(arm) * norm(change);
    }

    linear = std::max(linear, norm(impulse) / size);
    angular = std::max(angular, norm(torque) / turn);
  }

  run.bound("sum of the impulses / their sizes", linear, 1e-8);
  run.bound("sum of the torques / their sizes", angular, 1e-6);
}

/// The same sheet. Source: a step of backward Euler minimises ½‖x − x̃‖²_M/dt² + W(x), hence
/// kinetic and elastic energy together do not grow without external work. Protocol: constant
/// coefficients, three lengths of step, the largest growth in a step relative to the energy at the
/// start.
void energy(CaseRun& run) {
  for (const double dt : {0.002, 0.01, 0.03}) {
    // The sheet starts deformed and thrown.
    auto scene = exact_scene("energy");
    scene->parameters.gravity.y = 0;
    scene->parameters.step.time_step = dt;
    scene->cloths = {small_sheet(1e-5)};
    run.start(scene);
    std::vector<Vec3d> x, v;
    deform(scene->cloths[0].rest, x, v);
    run.set_state(x, v);

    // The energy of each step is compared with that of the step before.
    double first = 0, last = 0, growth = 0;
    for (int k = 0; k < 60; ++k) {
      const StepReport report = run.step();
      const double now = report.kinetic_energy + report.elastic_energy;
      if (k == 0)
        first = now;
      else
        growth = std::max(growth, (now - last) / first);
      last = now;
    }
    run.bound("largest growth in a step, dt = " + std::to_string(dt).substr(0, 5), growth, 1e-9);
  }
}

/// The order of backward Euler. Source: it is of first order, so the error of a step dt/2ⁿ against
/// dt/16 is C dt (2⁻ⁿ − 1/16), and halving divides it by 15/7, then by 7/3.
void time_order(CaseRun& run) {
  double error[3];
  errors_of_steps(run, Integrator::backward_euler, error);
  run.compare("error(dt) / error(dt/2)", 15.0 / 7, error[0] / error[1], 0.05);
  run.compare("error(dt/2) / error(dt/4)", 7.0 / 3, error[1] / error[2], 0.05);
}

/// The order of BDF2. Source: it is of second order, so the error is C dt² (4⁻ⁿ − 1/256), and
/// halving divides it by 85/21, then by 21/5. The larger steps are not yet in that regime, so the
/// target is for the smaller ones.
void time_order_bdf2(CaseRun& run) {
  double error[3];
  errors_of_steps(run, Integrator::bdf2, error);
  run.compare("error(dt/2) / error(dt/4)", 21.0 / 5, error[1] / error[2], 0.05);
  double euler[3];
  errors_of_steps(run, Integrator::backward_euler, euler);
  run.bound("error(dt) of BDF2 / of backward Euler", error[0] / euler[0], 0.1);
}

}  // namespace icloth::validation
