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

/// H/W of a strip of `elements` rows under the load Γ = ρ g L³/D. Two rows are clamped; the clamp is
/// in the middle between them, where the tangent is level.
double drop_over_reach(CaseRun& run, double gamma, Index elements) {
  const double length = 0.2, modulus = 1e-5;
  Strip strip;
  strip.rows = elements + 1;
  strip.columns = elements / 5;
  const double row = length / (elements + 0.5);
  strip.length = row * strip.rows;
  const double density = gamma * modulus / (kGravity * std::pow(length, 3));
  auto scene = exact_scene("cantilever");
  scene->cloths = {strip_cloth(strip, [](double u, double v) { return Vec3d{v, 0, u}; },
                               plain_fabric(1e5 * modulus / (row * row), 0, density, modulus))};
  pin_row(scene->cloths[0], strip, 0);
  pin_row(scene->cloths[0], strip, 1);
  run.start(scene);
  const double slow = std::sqrt(length / kGravity);
  run.relax(0.05 * slow, 10 * slow, 1e-7 * length, 2000);
  const Vec3d tip = row_mean(strip, run.positions(), strip.rows);
  return -tip.y / (tip.x - 0.5 * row);
}

}  // namespace

/// A strip clamped level bends down under its weight. Source: the heavy elastica (Romero et al.
/// 2021, "Physical validation of simulators in computer graphics", test 1), H/W of the tip as a
/// function of Γ = ρ g L³/D alone. Protocol: L = 0.2 m, equilateral triangles, as wide as 1/6 of the
/// length and practically inextensible, which keeps the strip a cylinder, at rest.
void cantilever(CaseRun& run) {
  const std::vector<double> loads = run.brief() ? std::vector{10.0} : std::vector{1.0, 10.0, 100.0};
  for (const double gamma : loads) {
    const HeavyElastica exact = heavy_elastica(gamma);
    const double reference = exact.drop / exact.reach;
    const std::string load = ", load " + std::to_string(static_cast<int>(gamma));
    double error[3] = {};
    for (const int n : {0, 1, 2}) {
      if (run.brief() && n == 2) break;
      const Index elements = 10 << n;
      const double measured = drop_over_reach(run, gamma, elements);
      error[n] = measured / reference - 1;
      if (n == 2 || run.brief())
        run.compare("H/W, " + std::to_string(elements) + " elements" + load, reference, measured,
                    run.brief() ? 0.05 : 0.02);
    }
    if (!run.brief())
      run.compare("order of convergence" + load, 2, std::log2(std::fabs(error[0] / error[2])) / 2,
                  0.25);
  }
}

}  // namespace icloth::validation
