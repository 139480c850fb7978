// Heavy strips clamped at one end: the amount by which they bend down, and the load at which they
// fall over.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/cases.h"
#include "app/suites/validation/references.h"
#include "app/suites/validation/strips.h"

namespace icloth::validation {
namespace {

constexpr double kGravity = 9.81;

/// Poisson's ratio of the bending of plain_fabric. Hinges on equilateral triangles make a plate
/// with −1/3, whatever the fabric says.
double bending_poisson(BendingModel model) { return model == BendingModel::hinge ? -1.0 / 3 : 0; }

/// H/W of a strip of `elements` rows under the load Γ = ρ g L³/D. Two rows are clamped; the clamp
/// is in the middle between them, where the tangent is level.
double drop_over_reach(CaseRun& run, BendingModel model, double gamma, Index elements) {
  const double length = 0.2, modulus = 1e-5;

  // The strip has half a row beyond the clamp, so its rows are a little shorter than an element.
  Strip strip;
  strip.rows = elements + 1;
  strip.columns = elements / 5;
  const double row = length / (elements + 0.5);
  strip.length = row * strip.rows;
  const double density = gamma * modulus / (kGravity * std::pow(length, 3));

  // The fabric is practically inextensible, and its density gives the load Γ.
  auto scene = exact_scene("cantilever");
  scene->parameters.material.bending = model;
  scene->parameters.implicit.cg_tolerance = 1e-3;  // each step corrects the one before
  scene->cloths = {strip_cloth(
      strip,
      [](double u, double v) {
        return Vec3d{v, 0, u};
      },
      plain_fabric(4e9 * modulus, 0, density, modulus))};
  pin_row(scene->cloths[0], strip, 0);
  pin_row(scene->cloths[0], strip, 1);

  run.start(scene);

  // The relaxation steps follow the time that the strip takes to fall.
  const double slow = std::sqrt(length / kGravity);
  run.relax(0.05 * slow, 10 * slow, 1e-6 * length, 2000);
  const Vec3d tip = row_mean(strip, run.positions(), strip.rows);
  return -tip.y / (tip.x - 0.5 * row);
}

/// The growth of a small lateral deflection of a strip on edge, in a damped Newton step under
/// gravity g. Such a step maps z to (1 − (K⁺ + M/dt²)⁻¹ K) z. After a few of them only the mode
/// that buckles first is left, and it grows by more than 1 when its stiffness is negative.
double lateral_growth(CaseRun& run, const Strip& strip, const std::vector<Vec3d>& flat, double g) {
  // The strip first comes to rest in its plane.
  Parameters p = run.parameters();
  const double slow = std::sqrt(strip.length / g);
  p.gravity.y = -g;
  p.step.time_step = 10 * slow;
  p.implicit.newton_iterations = 1;
  run.set_parameters(p);
  run.set_state(flat, {});
  run.relax(slow, 10 * slow, 1e-9 * strip.length, 200);

  // Then it is pushed sideways by a small amount, step after step from rest.
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
double buckling_load(CaseRun& run, BendingModel model, const Strip& strip, double expected) {
  const double density = 0.2, modulus = 1e-5;
  const double row = strip.row_height(), length = strip.length - 0.5 * row;

  // The strip stands on edge, clamped as in drop_over_reach.
  auto scene = exact_scene("lateral buckling");
  scene->parameters.material.bending = model;
  scene->parameters.implicit.cg_tolerance = 1e-6;
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

  // The secant method starts from loads on both sides of the expected one.
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
/// function of Γ = ρ g L³/D alone. Protocol: L = 0.2 m, equilateral triangles, a fifth as wide as
/// long, practically inextensible, at rest, with both laws of bending. The order of convergence is
/// that of the differences between 10, 20 and 40 elements, for plates only: hinges with their ν =
/// −1/3 curl the free borders, in a strip whose width depends on the mesh.
void cantilever(CaseRun& run) {
  const std::vector<double> loads = run.brief() ? std::vector{10.0} : std::vector{1.0, 10.0, 100.0};

  for (const double gamma : loads) {
    const HeavyElastica exact = heavy_elastica(gamma);
    const double reference = exact.drop / exact.reach;
    const std::string load = ", load " + std::to_string(static_cast<int>(gamma));

    // Both laws of bending are held against the elastica.
    const Index most = run.brief() ? 20 : 40;
    const std::string what = "H/W, " + std::to_string(most) + " elements" + load;
    const double plates = drop_over_reach(run, BendingModel::plate, gamma, most);
    run.compare(what + ", plates", reference, plates, 0.02);
    run.compare(what + ", hinges", reference,
                drop_over_reach(run, BendingModel::hinge, gamma, most), 0.02);

    // Plates also have to converge at second order.
    if (run.brief()) continue;
    const double coarse = drop_over_reach(run, BendingModel::plate, gamma, 10);
    const double middle = drop_over_reach(run, BendingModel::plate, gamma, 20);
    run.compare("order of convergence" + load, 2,
                std::log2(std::fabs((middle - coarse) / (plates - middle))), 0.25);
  }
}

/// A strip clamped on edge falls over sideways above a load. Source: lateral buckling of a
/// cantilever under its own weight, q L³/√(B C) = 12.854 (Timoshenko and Gere, "Theory of elastic
/// stability"; Romero et al. 2021, test 3). A narrow plate has B = D(1 − ν²)w, C = 2D(1 − ν)w:
/// Γ = 12.854 (1 − ν) √(2(1 + ν)). Protocol: the load at which a small lateral deflection neither
/// grows nor shrinks, by the secant method, for widths of 0.15 L and 0.08 L, continued to 0 (the
/// clamp keeps a wide strip from warping and so shortens it).
void lateral_buckling(CaseRun& run) {
  // The two widths are continued linearly to zero.
  constexpr Index kColumns = 6;
  const Strip wide{0.2, 15 * kColumns / 2, kColumns}, narrow{0.2, 15 * kColumns, kColumns};

  for (const BendingModel model : {BendingModel::plate, BendingModel::hinge}) {
    const double poisson = bending_poisson(model);
    const double reference = 12.854 * (1 - poisson) * std::sqrt(2 * (1 + poisson));
    const double load = 2 * buckling_load(run, model, narrow, reference) -
                        buckling_load(run, model, wide, reference);
    const char* name = model == BendingModel::plate ? "plates" : "hinges";
    run.compare(std::string("load at which it falls over, ") + name, reference, load, 0.05);
  }
}

}  // namespace icloth::validation
