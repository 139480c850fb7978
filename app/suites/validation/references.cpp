#include "app/suites/validation/references.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace icloth::validation {
namespace {

/// The root of an increasing function in [low, high], by bisection.
template <class Function>
double root(const Function& f, double low, double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Integrates from 0 to 1 in `count` steps of the classical Runge–Kutta method.
template <std::size_t N, class Function>
std::array<double, N> integrate(std::array<double, N> y, int count, const Function& f) {
  const double h = 1.0 / count;
  const auto moved = [&](const std::array<double, N>& k, double by) {
    std::array<double, N> out = y;
    for (std::size_t i = 0; i < N; ++i) out[i] += by * k[i];
    return out;
  };

  // Four slopes a step leave an error of fourth order in its length.
  for (int n = 0; n < count; ++n) {
    const double s = n * h;
    const auto k1 = f(s, y), k2 = f(s + h / 2, moved(k1, h / 2));
    const auto k3 = f(s + h / 2, moved(k2, h / 2)), k4 = f(s + h, moved(k3, h));
    for (std::size_t i = 0; i < N; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return y;
}

/// Makes one Newton step for residual(u, parameter) = 0 with difference quotients.
template <std::size_t N, class Function>
std::array<double, N> newton_step(const Function& residual, std::array<double, N> u,
                                  double parameter) {
  // The right side is the residual, and the Jacobian follows column by column from differences.
  const std::array<double, N> r = residual(u, parameter);
  std::array<std::array<double, N + 1>, N> rows;
  for (std::size_t i = 0; i < N; ++i) rows[i][N] = -r[i];
  for (std::size_t j = 0; j < N; ++j) {
    std::array<double, N> moved = u;
    const double h = 1e-7 * (1 + std::fabs(u[j]));
    moved[j] += h;
    const std::array<double, N> there = residual(moved, parameter);
    for (std::size_t i = 0; i < N; ++i) rows[i][j] = (there[i] - r[i]) / h;
  }

  // The linear system is solved by Gauss and Jordan's method with pivots.
  for (std::size_t c = 0; c < N; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < N; ++i)
      if (std::fabs(rows[i][c]) > std::fabs(rows[pivot][c])) pivot = i;
    std::swap(rows[c], rows[pivot]);

    for (std::size_t i = 0; i < N; ++i) {
      if (i == c) continue;
      const double factor = rows[i][c] / rows[c][c];
      for (std::size_t j = c; j <= N; ++j) rows[i][j] -= factor * rows[c][j];
    }
  }

  for (std::size_t i = 0; i < N; ++i) u[i] += rows[i][N] / rows[i][i];
  return u;
}

/// θ, θ', ∫ sin θ and ∫ cos θ of the pressed strip at arc length s.
std::array<double, 4> pressed_end(const PressedElastica& e, double s) {
  using State = std::array<double, 4>;
  return integrate<4>({0, e.curvature, 0, 0}, 200, [&](double, const State& y) -> State {
    const double sine = std::sin(y[0]), cosine = std::cos(y[0]);
    return {s * y[1], s * (-e.pressure * sine + e.sideways * cosine), s * sine, s * cosine};
  });
}

}  // namespace

double hanging_elongation(double length, double density, double gravity, double tensile) {
  // The midpoint rule, far finer than it has to be.
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
  // One zero each lies between (n − 1/2)π and nπ; the sign of J₀ there alternates.
  const double sign = n % 2 == 1 ? -1 : 1;
  return root([&](double x) { return sign * std::cyl_bessel_j(0.0, x); },
              (n - 0.5) * std::numbers::pi, n * std::numbers::pi);
}

HeavyElastica heavy_elastica(double gamma) {
  // The equation is integrated from the tip, σ = 1 − s, in the angle φ = π/2 − θ from the plumb
  // line, which is tiny there for a limp strip: φ_σσ = Γ σ sin φ, φ_σ(0) = 0. Bisection on φ(0)
  // finds φ(1) = π/2. Holding the angle at π/2 in the right side makes φ(1) increase with φ(0).
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

double PressedElastica::friction() const { return std::fabs(sideways) / pressure; }

PressedElastica pressed_elastica(double shortening) {
  // Newton's method with differences starts from the buckled shape of a small shortening; the
  // branch turns smoothly. A clamped and hinged strip buckles at P = 4.4934².
  using Vector = std::array<double, 3>;
  const auto residual = [](const Vector& u, double wanted) -> Vector {
    const auto end = pressed_end({u[0], u[1], u[2]}, 1);
    return {end[1], end[2], end[3] - (1 - wanted)};
  };

  // The shortening grows in stages, with the solution of one as the start of the next.
  constexpr int kStages = 15;
  const double first = std::min(1e-4, shortening);
  Vector u{8 * std::sqrt(first), 20.19, -9 * std::sqrt(first)};
  for (int stage = 0; stage <= kStages; ++stage) {
    const double share = static_cast<double>(stage) / kStages;
    const double wanted = first + (shortening - first) * share * share;
    for (int k = 0; k < 6; ++k) u = newton_step<3>(residual, u, wanted);
  }
  return {u[0], u[1], u[2]};
}

std::array<double, 2> pressed_point(const PressedElastica& elastica, double s) {
  const auto end = pressed_end(elastica, s);
  return {end[2], end[3]};
}

double belt_leg(double friction, double leg, double radius) {
  // All forces are in units of ρ g: T(0) is the length of one leg, T(π) that of the heavy one.
  constexpr double kPi = std::numbers::pi;
  const auto slope = [&](double s, const std::array<double, 1>& t) -> std::array<double, 1> {
    const double phi = kPi * s;
    return {kPi * (friction * t[0] + radius * (std::cos(phi) + friction * std::sin(phi)))};
  };
  return integrate<1>({leg}, 400, slope)[0];
}

double belt_friction(double light_leg, double heavy_leg, double radius) {
  return root([&](double f) { return belt_leg(f, light_leg, radius) - heavy_leg; }, 0, 3);
}

}  // namespace icloth::validation
