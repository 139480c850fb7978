#include "app/validation/references.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace icloth::validation {
namespace {

/// Root of an increasing function in [low, high].
template <class Function>
double root(const Function& f, double low, double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Classical Runge–Kutta, `count` steps over [0, 1].
template <std::size_t N, class Function>
std::array<double, N> integrate(std::array<double, N> y, int count, const Function& f) {
  const double h = 1.0 / count;
  const auto moved = [&](const std::array<double, N>& k, double by) {
    std::array<double, N> out = y;
    for (std::size_t i = 0; i < N; ++i) out[i] += by * k[i];
    return out;
  };
  for (int n = 0; n < count; ++n) {
    const double s = n * h;
    const auto k1 = f(s, y), k2 = f(s + h / 2, moved(k1, h / 2));
    const auto k3 = f(s + h / 2, moved(k2, h / 2)), k4 = f(s + h, moved(k3, h));
    for (std::size_t i = 0; i < N; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return y;
}

}  // namespace

double hanging_elongation(double length, double density, double gravity, double tensile) {
  // Midpoint rule, far finer than it has to be.
  constexpr int kCells = 20000;
  double sum = 0;
  for (int i = 0; i < kCells; ++i) {
    const double weight = density * gravity * length * (i + 0.5) / kCells;
    const double stretch =
        root([&](double l) { return l * (l * l - 1) * tensile / 2 - weight; }, 1, 100);
    sum += (stretch - 1) * length / kCells;
  }
  return sum;
}

Catenary catenary(double ratio) {
  const double z = root([&](double y) { return std::sinh(y) / y - ratio; }, 1e-6, 50);
  const double a = 1 / (2 * z);
  return {a * (std::cosh(z) - 1), a, std::atan(std::sinh(z))};
}

double bessel_zero(int n) {
  // Zeros lie one each between (n − 1/2)π and nπ; the sign of J₀ there alternates.
  const double sign = n % 2 == 1 ? -1 : 1;
  return root([&](double x) { return sign * std::cyl_bessel_j(0.0, x); },
              (n - 0.5) * std::numbers::pi, n * std::numbers::pi);
}

HeavyElastica heavy_elastica(double gamma) {
  // From the tip, σ = 1 − s, in the angle φ = π/2 − θ from the plumb line, which is tiny there for
  // a limp strip: φ_σσ = Γ σ sin φ, φ_σ(0) = 0. Bisection on φ(0) until φ(1) = π/2; held at π/2 the
  // right side makes φ(1) increase with φ(0).
  using State = std::array<double, 4>;  // φ, φ_σ, reach, drop
  const auto slope = [&](double sigma, const State& y) -> State {
    const double load = gamma * sigma * std::sin(std::min(y[0], std::numbers::pi / 2));
    return {y[1], load, std::sin(y[0]), std::cos(y[0])};
  };
  const auto shoot = [&](double log_tip) {
    return integrate<4>({std::exp(log_tip), 0, 0, 0}, 4000, slope);
  };
  const double log_tip = root([&](double t) { return shoot(t)[0] - std::numbers::pi / 2; }, -200,
                              std::log(std::numbers::pi / 2));
  const State end = shoot(log_tip);
  return {end[3], end[2], std::numbers::pi / 2 - std::exp(log_tip)};
}

}  // namespace icloth::validation
