// Heavy strips clamped at one end: how far they bend down, and when they fall over.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/validation/case_run.h"
#include "app/validation/cases.h"
#include "app/validation/references.h"
#include "app/validation/strips.h"

namespace icloth::validation {
namespace {

constexpr double kGravity = 9.81;
/// Of the plate that hinges on equilateral triangles make.
constexpr double kBendingPoisson = -1.0 / 3;

/// H/W of a strip of `elements` rows under the load Γ = ρ g L³/D. Two rows are clamped; the clamp
/// is in the middle between them, where the tangent is level.
double drop_over_reach(CaseRun& run, double gamma, Index elements) {
  const double length = 0.2, modulus = 1e-5;
  Strip strip;
  strip.rows = elements + 1;
  strip.columns = elements / 2;
  const double row = length / (elements + 0.5);
  strip.length = row * strip.rows;
  const double density = gamma * modulus / (kGravity * std::pow(length, 3));
  auto scene = exact_scene("cantilever");
  scene->parameters.cg_tolerance = 1e-3;  // each step corrects the one before
  scene->cloths = {strip_cloth(
      strip,
      [](double u, double v) {
        return Vec3d{v, 0, u};
      },
      plain_fabric(4e9 * modulus, 0, density, modulus))};
  pin_row(scene->cloths[0], strip, 0);
  pin_row(scene->cloths[0], strip, 1);
  run.start(scene);
  const double slow = std::sqrt(length / kGravity);
  run.relax(0.05 * slow, 10 * slow, 1e-6 * length, 2000);
  const Vec3d tip = row_mean(strip, run.positions(), strip.rows);
  return -tip.y / (tip.x - 0.5 * row);
}

/// By how much a small lateral deflection of a strip on edge grows in a damped Newton step under
/// gravity g. Such a step maps z to (1 − (K⁺ + M/dt²)⁻¹ K) z: after a few of them only the mode
/// that buckles first is left, and it grows by more than 1 when its stiffness is negative.
double lateral_growth(CaseRun& run, const Strip& strip, const std::vector<Vec3d>& flat, double g) {
  Parameters p = run.parameters();
  const double slow = std::sqrt(strip.length / g);
  p.gravity_y = -g;
  p.time_step = 10 * slow;
  p.newton_iterations = 1;
  run.set_parameters(p);
  run.set_state(flat, {});
  run.relax(slow, 10 * slow, 1e-9 * strip.length, 200);
  std::vector<Vec3d> x = run.positions();
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i].z = 1e-7 * strip.length * std::pow(x[i].x / strip.length, 2);
  double last = 1, growth = 1;
  for (int k = 0; k < 12; ++k) {
    run.set_state(x, {});
    run.step();
    x = run.positions();
    const double now = row_mean(strip, x, strip.rows).z;
    growth = now / last;
    last = now;
  }
  return growth;
}

/// The load Γ at which a strip clamped on edge buckles.
double buckling_load(CaseRun& run, const Strip& strip, double expected) {
  const double density = 0.2, modulus = 1e-5;
  const double row = strip.row_height(), length = strip.length - 0.5 * row;
  auto scene = exact_scene("lateral buckling");
  scene->parameters.cg_tolerance = 1e-6;
  scene->cloths = {strip_cloth(
      strip,
      [&](double u, double v) {
        return Vec3d{v - row / 2, u, 0};
      },
      plain_fabric(1e3 * modulus / (row * row), 0, density, modulus))};
  pin_row(scene->cloths[0], strip, 0);
  pin_row(scene->cloths[0], strip, 1);
  run.start(scene);
  const std::vector<Vec3d> flat = run.positions();
  const double unit = modulus / (density * std::pow(length, 3));  // g of a load of 1
  double load[2] = {0.9 * expected, 1.1 * expected}, excess[2];
  for (const int k : {0, 1}) excess[k] = lateral_growth(run, strip, flat, unit * load[k]) - 1;
  for (int k = 0; k < 3; ++k) {
    const double next = load[1] - excess[1] * (load[1] - load[0]) / (excess[1] - excess[0]);
    load[0] = load[1], excess[0] = excess[1];
    load[1] = next, excess[1] = lateral_growth(run, strip, flat, unit * next) - 1;
  }
  return load[1];
}

}  // namespace

/// A strip clamped level bends down under its weight. Source: the heavy elastica (Romero et al.
/// 2021, "Physical validation of simulators in computer graphics", test 1), H/W of the tip as a
/// function of Γ = ρ g L³/D alone. Protocol: L = 0.2 m, equilateral triangles, half as wide as
/// long and practically inextensible, which keeps the strip a cylinder, at rest. The order is that
/// of the differences between 10, 20 and 40 elements.
void cantilever(CaseRun& run) {
  const std::vector<double> loads = run.brief() ? std::vector{10.0} : std::vector{1.0, 10.0, 100.0};
  for (const double gamma : loads) {
    const HeavyElastica exact = heavy_elastica(gamma);
    const double reference = exact.drop / exact.reach;
    const std::string load = ", load " + std::to_string(static_cast<int>(gamma));
    double measured[3] = {};
    for (const int n : {0, 1, 2})
      if (!run.brief() || n == 1) measured[n] = drop_over_reach(run, gamma, 10 << n);
    if (run.brief()) {
      run.compare("H/W, 20 elements" + load, reference, measured[1], 0.02);
      continue;
    }
    run.compare("H/W, 40 elements" + load, reference, measured[2], 0.02);
    const double ratio = (measured[1] - measured[0]) / (measured[2] - measured[1]);
    run.compare("order of convergence" + load, 2, std::log2(std::fabs(ratio)), 0.25);
  }
}

/// A strip clamped on edge falls over sideways above a load. Source: lateral buckling of a
/// cantilever under its own weight, q L³/√(B C) = 12.854 (Timoshenko and Gere, "Theory of elastic
/// stability"; Romero et al. 2021, test 3). A narrow plate has B = D(1 − ν²)w, C = 2D(1 − ν)w:
/// Γ = 12.854 (1 − ν) √(2(1 + ν)). Protocol: the load at which a small lateral deflection neither
/// grows nor shrinks, by the secant method, for widths of 0.15 L and 0.08 L, continued to 0 (the
/// clamp keeps a wide strip from warping and so shortens it).
void lateral_buckling(CaseRun& run) {
  const double reference = 12.854 * (1 - kBendingPoisson) * std::sqrt(2 * (1 + kBendingPoisson));
  const Index columns = 6;
  const Strip wide{0.2, 15 * columns / 2, columns}, narrow{0.2, 15 * columns, columns};
  const double loads[2] = {buckling_load(run, wide, reference),
                           buckling_load(run, narrow, reference)};
  run.compare("load at which it falls over", reference, 2 * loads[1] - loads[0], 0.05);
}

}  // namespace icloth::validation
