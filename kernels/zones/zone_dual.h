// The dual solver of an impact zone: accelerated projected gradient on the multipliers.
//
//   x(λ) = x* + a⁻¹ Jᵀ λ,   λ⁺ = max(y + (δ − J x(y)) / L, 0),   y = λ⁺ + β (λ⁺ − λ)
//
// J: rows w ⊗ n of the constraints. L_j is Gershgorin's bound of row j of J a⁻¹ Jᵀ, which makes
// every step safe without a line search and without a penalty. Momentum restarts when it points
// uphill (O'Donoghue and Candès 2015). The multipliers are impulses, never negative, and every
// iterate keeps the momentum of the zone by construction.
#pragma once

#include "kernels/zones/zone_problem.h"

namespace icloth::ICLOTH_BUILD {

/// The dual solver; the head of this file has the method.
template <class Team>
class ZoneDual : public ZoneProblem<Team> {
 public:
  using Base = ZoneProblem<Team>;
  using Base::Base;

  /// Iterates until no projected step would change a gap by more than a fifth of δ: then no
  /// constraint is short by more, and none is pushed further than needed by more. Returns the
  /// number of iterations.
  ICLOTH_HD int solve() {
    prepare();

    double t = 1;
    int k = 0;
    for (; k < set_.iterations; ++k) {
      // A projected gradient step starts from the extrapolated multipliers. When it changes no gap
      // any more, its result is the answer.
      positions(y_);
      const Step step = project();
      if (step.largest <= set_.tolerance) {
        team_.for_each(nc_, [&](Index j) { multiplier_[j] = projected_[j]; });
        break;
      }

      // Nesterov's extrapolation starts again when it points uphill.
      const bool uphill = step.momentum > 0;
      const double next = uphill ? 1 : 0.5 * (1 + std::sqrt(1 + 4 * t * t));
      const Real beta = uphill ? Real(0) : static_cast<Real>((t - 1) / next);
      t = next;
      team_.for_each(nc_, [&](Index j) {
        const Real projected = projected_[j];
        y_[j] = projected + beta * (projected - multiplier_[j]);
        multiplier_[j] = projected;
      });
    }

    positions(multiplier_);
    return k;
  }

 private:
  using Base::constraints_, Base::multiplier_, Base::nc_, Base::nv_, Base::set_, Base::target_,
      Base::team_, Base::x_;
  View<Real> y_ = Base::scratch1_;           ///< the extrapolated multipliers y
  View<Real> bound_ = Base::scratch2_;       ///< L of each constraint
  View<Real> projected_ = Base::shortfall_;  ///< λ⁺; its memory is free until finish()

  struct Step {
    double momentum;  ///< Σ L (y − λ⁺)(λ⁺ − λ), positive where the extrapolation points uphill
    Real largest;  ///< L |λ⁺ − y|
  };
  struct CombineSteps {
    ICLOTH_HD Step operator()(Step a, Step b) const {
      return {a.momentum + b.momentum, Max{}(a.largest, b.largest)};
    }
  };

  /// Computes the bounds L and starts from the multipliers of the last round.
  ICLOTH_HD void prepare() {
    team_.for_each(nc_, [&](Index j) {
      Real bound = 0;
      for (int a = 0; a < 4; ++a) {
        const Index i = this->corner(j, a);
        if (i >= 0) bound += std::fabs(constraints_[j].s.w[a]) * influence(i);
      }
      bound_[j] = bound;
      y_[j] = multiplier_[j] = std::fmax(multiplier_[j], Real(0));
    });
  }

  /// Σ |w| / a_i over the constraints of vertex i: how far unit multipliers move it at most.
  ICLOTH_HD Real influence(Index i) const {
    Real sum = 0;
    this->for_constraints(i, [&](Index, Real w) { sum += std::fabs(w); });
    return sum / static_cast<Real>(this->weight(i));
  }

  /// Sets x to x(λ).
  ICLOTH_HD void positions(View<const Real> lambda) const {
    team_.for_each(nv_, [&](Index i) {
      Vec3r pull{};
      this->for_constraints(
          i, [&](Index j, Real w) { pull += (w * lambda[j]) * constraints_[j].normal; });
      x_[i] = target_[i] + (Real(1) / static_cast<Real>(this->weight(i))) * pull;
    });
  }

  /// Sets λ⁺ from the gaps at x(y), and measures the step that leads to it.
  ICLOTH_HD Step project() const {
    return team_.reduce(
        nc_, Step{0, 0},
        [&](Index j) {
          const Real s = this->shortfall_at(j, [&](Index i) -> const Vec3r& { return x_[i]; });
          const Real y = y_[j];
          const Real next = bound_[j] > 0 ? std::fmax(y + s / bound_[j], Real(0)) : Real(0);
          projected_[j] = next;
          const Real change = bound_[j] * (y - next);
          return Step{static_cast<double>(change * (next - multiplier_[j])), std::fabs(change)};
        },
        CombineSteps{});
  }
};

}  // namespace icloth::ICLOTH_BUILD
