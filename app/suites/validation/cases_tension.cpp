// Strips in tension: under their own weight, between two ends, and swinging.
#include <cmath>
#include <complex>
#include <numbers>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/cases.h"
#include "app/suites/validation/references.h"
#include "app/suites/validation/strips.h"

namespace icloth::validation {
namespace {

using Complex = std::complex<double>;

constexpr double kGravity = 9.81, kPi = std::numbers::pi;

/// The frequency of a small motion out of plane that starts as `shape(v)` and is projected on it.
/// Backward Euler turns x + i v/ω by atan(ω dt) a step; the measured turn gives ω = tan(turn)/dt.
double measured_frequency(CaseRun& run, const Cloth& cloth,
                          const std::function<double(std::size_t)>& shape, double expected) {
  Parameters p = run.parameters();
  p.step.time_step = 0.1 / expected;
  run.set_parameters(p);

  // The strip starts at rest with a small displacement of that shape.
  std::vector<Vec3d> x = run.positions();
  const std::vector<double> mass = lumped_mass(cloth);
  const double displacement = 1e-5 * norm(x.back() - x.front());
  for (std::size_t i = 0; i < mass.size(); ++i) x[i].z += displacement * shape(i);
  run.set_state(x, {});

  // Position and velocity of the mode are the parts of a complex number.
  const auto projected = [&] {
    const Snapshot state = run.simulator().snapshot();
    Complex sum;
    for (std::size_t i = 0; i < mass.size(); ++i)
      sum += mass[i] * shape(i) * Complex(state.x1[i].z, state.v[i].z / expected);
    return sum;
  };

  // Its argument turns from step to step.
  double turned = 0;
  Complex last = projected();
  constexpr int kSteps = 126;  // about two periods
  for (int k = 0; k < kSteps; ++k) {
    run.step();
    const Complex now = projected();
    turned -= std::arg(now / last);
    last = now;
  }

  return std::tan(turned / kSteps) / p.step.time_step;
}

}  // namespace

/// A strip hangs by one end. Source: balance of forces with the second Piola stress k G (ν = 0), by
/// which the local stretch solves λ(λ² − 1)k/2 = ρ g (L − s). Protocol: L = 1 m, ρ = 0.187 kg/m²,
/// 40 rows, at rest; measured is the elongation of the last row.
void hanging_strip(CaseRun& run) {
  const Strip strip{1, 40, 2};
  for (const double tensile : {50.0, 100.0, 500.0}) {
    auto scene = exact_scene("hanging strip");
    scene->cloths = {strip_cloth(
        strip,
        [](double u, double v) {
          return Vec3d{u, -v, 0};
        },
        plain_fabric(tensile, 0, 0.187, 1e-6))};
    pin_row(scene->cloths[0], strip, 0);

    run.start(scene);
    run.relax(0.1, 10, 1e-9, 200);

    // The last row has moved down by the elongation of the whole strip.
    const double elongation = -row_mean(strip, run.positions(), strip.rows).y - strip.length;
    run.compare("elongation, k = " + std::to_string(static_cast<int>(tensile)) + " N/m [m]",
                hanging_elongation(strip.length, 0.187, kGravity, tensile), elongation, 0.01);
  }
}

/// A strip hangs by both ends at one height. Source: the inextensible chain, sinh z / z = L/S, sag
/// = S (cosh z − 1)/2z. Protocol: 50 rows, no bending stiffness, k = 10⁵ ρ g L, from a circular arc
/// to rest.
void hung_chain(CaseRun& run) {
  const Strip strip{1, 50, 1};
  const double density = 0.2;
  const std::vector<double> ratios =
      run.brief() ? std::vector{1.2} : std::vector{1.02, 1.1, 1.2, 1.5, 2.0};
  for (const double ratio : ratios) {
    // The half angle of the arc of length L over the span solves sin β / β = S/L.
    double low = 1e-3, high = kPi;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (std::sin(middle) / middle > 1 / ratio ? low : high) = middle;
    }
    const double beta = low, radius = strip.length / (2 * beta);

    // The strip starts as that arc between its two ends.
    auto scene = exact_scene("catenary");
    scene->cloths = {strip_cloth(
        strip,
        [&](double u, double v) {
          const double angle = (2 * v / strip.length - 1) * beta;
          return Vec3d{radius * std::sin(angle), radius * (std::cos(beta) - std::cos(angle)), u};
        },
        plain_fabric(1e5 * density * kGravity, 0, density, 0))};
    pin_row(scene->cloths[0], strip, 0);
    pin_row(scene->cloths[0], strip, strip.rows);

    run.start(scene);
    run.relax(0.02, 2, 1e-6, 400);

    // The chain hangs lowest in the middle.
    const double sag = -row_mean(strip, run.positions(), strip.rows / 2).y;
    const double span = strip.length / ratio;
    run.compare("sag / span at L/S = " + std::to_string(ratio).substr(0, 4), catenary(ratio).sag,
                sag / span, 0.01);
  }
}

/// A strip that hangs by one end swings a little. Source: the hanging chain of Bernoulli and Euler,
/// ω_n = ½ j₀ₙ √(g/L), shape J₀(j₀ₙ √(1 − s/L)). Protocol: 80 rows, no bending stiffness,
/// practically inextensible, two periods of ω dt = 0.1 from each shape, corrected by backward
/// Euler's own phase.
void chain_frequencies(CaseRun& run) {
  const Strip strip{1, 80, 1};
  auto scene = exact_scene("chain frequencies");
  scene->cloths = {strip_cloth(
      strip,
      [](double u, double v) {
        return Vec3d{u, -v, 0};
      },
      plain_fabric(2000, 0, 0.187, 0))};
  pin_row(scene->cloths[0], strip, 0);

  const std::vector<Vec3d>& rest = scene->cloths[0].rest;

  // Each mode starts from rest in its own shape.
  for (int n = 1; n <= (run.brief() ? 2 : 3); ++n) {
    run.start(scene);
    run.relax(0.1, 10, 1e-9, 100);
    const double zero = bessel_zero(n);
    const auto shape = [&](std::size_t i) {
      return std::cyl_bessel_j(0.0, zero * std::sqrt(std::max(0.0, 1 - rest[i].y / strip.length)));
    };
    const double expected = 0.5 * zero * std::sqrt(kGravity / strip.length);
    run.compare("omega " + std::to_string(n) + " [1/s]", expected,
                measured_frequency(run, scene->cloths[0], shape, expected), 0.01);
  }
}

/// A strip stretched by 5 % between two ends swings a little, without gravity. Source: the string,
/// ω_n = nπ/L √(T/ρ), in rest coordinates T = k(λ² − 1)/2. Protocol as for the chain.
void string_frequencies(CaseRun& run) {
  const Strip strip{1, 40, 1};
  const double stretch = 1.05, tensile = 100, density = 0.2;
  auto scene = exact_scene("string frequencies");
  scene->parameters.gravity.y = 0;
  scene->cloths = {strip_cloth(
      strip,
      [&](double u, double v) {
        return Vec3d{u, stretch * v, 0};
      },
      plain_fabric(tensile, 0, density, 0))};
  pin_row(scene->cloths[0], strip, 0);
  pin_row(scene->cloths[0], strip, strip.rows);

  const std::vector<Vec3d>& rest = scene->cloths[0].rest;

  // The frequencies follow from the tension in rest coordinates.
  const double tension = tensile * (stretch * stretch - 1) / 2;
  for (int n = 1; n <= (run.brief() ? 2 : 3); ++n) {
    run.start(scene);
    const auto shape = [&](std::size_t i) { return std::sin(n * kPi * rest[i].y / strip.length); };
    const double expected = n * kPi / strip.length * std::sqrt(tension / density);
    run.compare("omega " + std::to_string(n) + " [1/s]", expected,
                measured_frequency(run, scene->cloths[0], shape, expected), 0.01);
  }
}

}  // namespace icloth::validation
