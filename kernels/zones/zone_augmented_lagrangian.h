// The paper's solver of an impact zone: an augmented Lagrangian (Section 4, Eq. 4–8, Algorithms 2
// and 3).
//
//   minimise ½ Σ a_i |x_i − x*_i|² + (μ/2) Σ c̃_j²,  c̃_j = max(δ − n_j·g_j(x) + λ_j/μ, 0),
//   λ_j ← μ c̃_j
//
// Deviations: the decrease test uses the preconditioned slope g·d in place of ‖ΔX‖²; X' of the
// Chebyshev step is the iterate before (Wang 2015); the iteration also ends when neither a
// constraint nor a position is off by more than a fifth of δ, since single precision cannot resolve
// a step of 10⁻¹² m; and a free zone is then shifted so that it keeps its momentum.
#pragma once

#include "kernels/zones/zone_problem.h"

namespace icloth::ICLOTH_BUILD {

/// The objective in its two parts.
struct ZoneObjective {
  double penalties, distance;
  ICLOTH_HD double value() const { return penalties + distance; }
  ICLOTH_HD friend ZoneObjective operator+(ZoneObjective a, ZoneObjective b) {
    return {a.penalties + b.penalties, a.distance + b.distance};
  }
};

/// The state of the constraints after an update of the multipliers.
struct ZoneState {
  double penalties;
  Real violation;  ///< largest shortfall
};
struct CombineZoneStates {
  ICLOTH_HD ZoneState operator()(ZoneState a, ZoneState b) const {
    return {a.penalties + b.penalties, Max{}(a.violation, b.violation)};
  }
};

/// The outcome of a Jacobi-preconditioned gradient.
struct Descent {
  double slope;  ///< gradient · direction
  Real off;      ///< largest |gradient| / a: how far a vertex is from where the forces balance [m]
};
struct CombineDescents {
  ICLOTH_HD Descent operator()(Descent a, Descent b) const {
    return {a.slope + b.slope, Max{}(a.off, b.off)};
  }
};

/// The paper's solver; the head of this file has the method and its deviations.
template <class Team>
class ZoneAugmentedLagrangian : public ZoneProblem<Team> {
 public:
  using Base = ZoneProblem<Team>;
  using Base::Base;

  /// Minimises and updates the multipliers in turn. Returns the number of iterations.
  ICLOTH_HD int solve() {
    prepare();
    Real omega = 1;
    int k = 0, since_restart = 0;
    for (; k < set_.iterations; ++k) {
      // The direction of descent tells whether the zone has converged.
      const Descent descent = team_.reduce(
          nv_, Descent{0, 0}, [&](Index i) { return descend(i); }, CombineDescents{});
      const double slope = descent.slope;
      if (state_.violation <= set_.tolerance && descent.off <= set_.tolerance) break;

      // Algorithm 3: the step length comes from a backtracking line search, and a vanishing one
      // ends the iteration.
      Real step = 1;
      ZoneObjective trial = line_search(slope, step);
      if (step * static_cast<Real>(std::sqrt(slope)) < set_.step_threshold) break;

      // Chebyshev acceleration (Eq. 8) starts again after every shortened step.
      if (!set_.chebyshev || step < 1) since_restart = 0;
      omega = chebyshev_weight(since_restart++, omega);
      move(step, omega);

      // Acceleration may overshoot where constraints switch on and off. The plain step is taken
      // back then, and the acceleration starts again.
      if (omega != 1) {
        const ZoneObjective accelerated = objective(Real(0));
        if (accelerated.value() <= trial.value()) {
          trial = accelerated;
        } else {
          team_.for_each(nv_, [&](Index i) { x_[i] += direction_[i]; });
          trial = objective(Real(0));
          since_restart = 0;
        }
      }

      // Algorithm 2: the multipliers take over what the penalty holds.
      update_multipliers();
      value_ = {state_.penalties, trial.distance};
    }
    this->restore_momentum();
    return k;
  }

 private:
  using Base::before_, Base::constraints_, Base::direction_, Base::multiplier_, Base::nc_,
      Base::nv_, Base::set_, Base::shortfall_, Base::target_, Base::team_, Base::x_;
  View<Real> trial_ = Base::scratch1_;  ///< shortfalls at the point that objective() was asked for

  /// Starts at the given positions with the multipliers of the last round.
  ICLOTH_HD void prepare() {
    team_.for_each(nv_, [&](Index i) { direction_[i] = Vec3r{}; });
    value_ = objective(Real(0));
    state_.violation = team_.reduce(
        nc_, -set_.offset, [&](Index j) { return shortfall_[j] = trial_[j]; }, Max{});
  }

  /// The penalty term of constraint j with the given shortfall.
  ICLOTH_HD double penalty(Index j, Real shortfall) const {
    const Real t = std::fmax(shortfall + multiplier_[j] / set_.penalty, Real(0));
    return static_cast<double>(Real(0.5) * set_.penalty * t * t);
  }

  /// The objective at x − step · direction. The shortfalls there are left in trial_.
  ICLOTH_HD ZoneObjective objective(Real step) const {
    // The sum runs over the constraints first and then over the vertices.
    return team_.reduce(
        nc_ + nv_, ZoneObjective{0, 0},
        [&](Index k) {
          if (k < nc_) {
            trial_[k] =
                this->shortfall_at(k, [&](Index i) { return x_[i] - step * direction_[i]; });
            return ZoneObjective{penalty(k, trial_[k]), 0};
          }
          const Index i = k - nc_;
          const Vec3r d = x_[i] - step * direction_[i] - target_[i];
          return ZoneObjective{0, 0.5 * this->weight(i) * static_cast<double>(norm2(d))};
        },
        Sum{});
  }

  /// Computes the Jacobi-preconditioned direction of one vertex (Algorithm 3, line 3) and returns
  /// its slope.
  ICLOTH_HD Descent descend(Index i) const {
    // Gradient and diagonal of the Hessian, to which only active constraints contribute pull.
    const Real a = static_cast<Real>(this->weight(i));
    Vec3r gradient = a * (x_[i] - target_[i]);
    Real diagonal = a;
    this->for_constraints(i, [&](Index j, Real w) {
      const Real pull = std::fmax(set_.penalty * shortfall_[j] + multiplier_[j], Real(0));
      gradient -= (w * pull) * constraints_[j].normal;
      diagonal += set_.penalty * w * w;
    });
    direction_[i] = (Real(1) / diagonal) * gradient;
    return {static_cast<double>(dot(gradient, direction_[i])), norm(gradient) / a};
  }

  /// Backtracking (Eq. 7), which begins with a whole step.
  ICLOTH_HD ZoneObjective line_search(double slope, Real& step) const {
    ZoneObjective trial = objective(step);
    for (int halvings = 0;
         halvings < 12 &&
         !(trial.value() <= value_.value() - 1e-4 * static_cast<double>(step) * slope);
         ++halvings) {
      step *= Real(0.5);
      trial = objective(step);
    }
    return trial;
  }

  /// ω of Eq. 8 after k iterations since the last start.
  ICLOTH_HD Real chebyshev_weight(int k, Real last) const {
    const Real rho2 = set_.rho * set_.rho;
    return k < 10 ? Real(1) : (k == 10 ? 2 / (2 - rho2) : 4 / (4 - rho2 * last));
  }

  /// Moves all vertices by the step, or by the Chebyshev combination with the iterate before it.
  ICLOTH_HD void move(Real step, Real omega) const {
    team_.for_each(nv_, [&](Index i) {
      const Vec3r old = x_[i], next = old - step * direction_[i];
      x_[i] = omega == 1 ? next : before_[i] + omega * (next - before_[i]);
      direction_[i] = next - x_[i];  // leads back from the accelerated point
      before_[i] = old;
    });
  }

  /// λ_j ← μ c̃_j with the shortfalls of the last objective.
  ICLOTH_HD void update_multipliers() {
    state_ = team_.reduce(
        nc_, ZoneState{0, -set_.offset},
        [&](Index j) {
          shortfall_[j] = trial_[j];
          multiplier_[j] = std::fmax(set_.penalty * shortfall_[j] + multiplier_[j], Real(0));
          return ZoneState{penalty(j, shortfall_[j]), shortfall_[j]};
        },
        CombineZoneStates{});
  }

  ZoneObjective value_{0, 0};  ///< at x with the present multipliers
  ZoneState state_{0, 0};
};

}  // namespace icloth::ICLOTH_BUILD
