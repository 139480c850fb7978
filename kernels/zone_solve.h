// One impact zone, solved by a team: the paper's augmented Lagrangian (Section 4, Eq. 4–8,
// Algorithms 2 and 3).
//
//   minimise ½ Σ a_i |x_i − x*_i|² + (μ/2) Σ c̃_j²,  c̃_j = max(δ − n_j·g_j(x) + λ_j/μ, 0),
//   λ_j ← μ c̃_j
//
// Deviations: every impact keeps an offset δ; a_i = m_i · mean(1/m) over the zone instead of
// 2 m_i / Σm, which makes μ independent of the size of the zone (the scaling of ARCSim); the
// decrease test uses the preconditioned slope g·d in place of ‖ΔX‖²; X' of the Chebyshev step is
// the iterate before (Wang 2015); the iteration also ends when no constraint is short by more than
// a fifth of δ, since single precision cannot resolve a step of 10⁻¹² m; and a free zone is then
// shifted so that it keeps its momentum.
#pragma once

#include "kernels/parallel.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

struct ZoneConstraint {
  Stencil s;     ///< obstacle vertices included
  Int4 slot;     ///< active vertex number of each corner, kNone where it cannot move
  Vec3r normal;  ///< towards the side of the start
};

struct ZoneSettings {
  Real offset;          ///< δ [m]
  Real penalty;         ///< μ
  Real rho;             ///< ρ of the Chebyshev step
  Real step_threshold;  ///< smallest step length
  int iterations;
  bool chebyshev;
};

struct ZoneResult {
  Index iterations;
  Real violation;  ///< largest δ − n·g left [m]
};

/// Mass and Σ m (x − x*) of some vertices.
struct ZoneMomentum {
  double mass;
  Vec3d moved;
  ICLOTH_HD friend ZoneMomentum operator+(ZoneMomentum a, ZoneMomentum b) {
    return {a.mass + b.mass, a.moved + b.moved};
  }
};

/// Buffers over all zones; a zone owns one range of constraints and one of active vertices.
struct ZoneArrays {
  View<const ZoneConstraint> constraints;
  View<const Index> constraint_first;  ///< (zones + 1)
  View<const Index> vertex_first;      ///< (zones + 1)
  View<const Index> incidence_first;   ///< (active vertices + 1)
  View<const Index> incidence;         ///< 4·constraint + corner, ascending
  View<const Vec3r> target;            ///< x*, unconstrained candidate of the active vertices [m]
  View<const Real> mass;               ///< of the active vertices [kg]
  View<const Vec3r> fixed;             ///< end-of-step positions of all vertices, for obstacles [m]
  View<Vec3r> x, before, direction;    ///< iterate k, iterate k−1, search direction [m]
  View<Real> multiplier, shortfall, trial;  ///< λ_j, c_j = δ − n·g(x), c_j at the trial point
  View<ZoneResult> result;                  ///< (zones)
};

/// The objective in its two parts.
struct ZoneObjective {
  double penalties, distance;
  ICLOTH_HD double value() const { return penalties + distance; }
  ICLOTH_HD friend ZoneObjective operator+(ZoneObjective a, ZoneObjective b) {
    return {a.penalties + b.penalties, a.distance + b.distance};
  }
};

/// What an update of the multipliers leaves.
struct ZoneState {
  double penalties;
  Real violation;  ///< largest shortfall
};
struct CombineZoneStates {
  ICLOTH_HD ZoneState operator()(ZoneState a, ZoneState b) const {
    return {a.penalties + b.penalties, Max{}(a.violation, b.violation)};
  }
};

/// One zone's share of the buffers, with vertices and constraints numbered within the zone, and
/// the solve on it. What is read and written all the time is borrowed: shared memory on CUDA.
template <class Team>
class ZoneSolver {
 public:
  ICLOTH_HD ZoneSolver(Team& team, const ZoneArrays& z, const ZoneSettings& set, Index zone)
      : team_(team),
        set_(set),
        first_constraint_(z.constraint_first[zone]),
        first_vertex_(z.vertex_first[zone]),
        nc_(z.constraint_first[zone + 1] - first_constraint_),
        nv_(z.vertex_first[zone + 1] - first_vertex_),
        x_(team.borrow(z.x.sub(first_vertex_, nv_))),
        direction_(team.borrow(z.direction.sub(first_vertex_, nv_))),
        before_(team.borrow(z.before.sub(first_vertex_, nv_))),
        target_(team.borrow(z.target.sub(first_vertex_, nv_))),
        mass_(team.borrow(z.mass.sub(first_vertex_, nv_))),
        shortfall_(team.borrow(z.shortfall.sub(first_constraint_, nc_))),
        trial_(team.borrow(z.trial.sub(first_constraint_, nc_))),
        multiplier_(team.borrow(z.multiplier.sub(first_constraint_, nc_))),
        constraints_(team.borrow(z.constraints.sub(first_constraint_, nc_))),
        incidence_first_(z.incidence_first.sub(first_vertex_, nv_ + 1)),
        incidence_(z.incidence),
        fixed_(z.fixed) {}

  /// Iterates until no constraint is short by more than a fifth of δ, then gives back.
  ICLOTH_HD ZoneResult solve() {
    prepare();
    Real omega = 1;
    int k = 0, since_restart = 0;
    for (; k < set_.iterations && state_.violation > Real(0.2) * set_.offset; ++k) {
      const double slope = team_.reduce(
          nv_, 0.0, [&](Index i) { return descend(i); }, Sum{});
      Real step = 1;
      ZoneObjective trial = line_search(slope, step);
      if (step * static_cast<Real>(std::sqrt(slope)) < set_.step_threshold) break;
      if (!set_.chebyshev || step < 1) since_restart = 0;
      omega = chebyshev_weight(since_restart++, omega);
      move(step, omega);
      if (omega != 1) {
        const ZoneObjective accelerated = objective(Real(0));
        if (accelerated.value() <= trial.value()) {
          trial = accelerated;
        } else {
          // Acceleration may overshoot where constraints switch on and off: it starts again.
          team_.for_each(nv_, [&](Index i) { x_[i] += direction_[i]; });
          trial = objective(Real(0));
          since_restart = 0;
        }
      }
      update_multipliers();
      value_ = {state_.penalties, trial.distance};
    }
    restore_momentum();
    return {static_cast<Index>(k), state_.violation};
  }

  /// Writes what was found to where it was borrowed from.
  ICLOTH_HD void give_back(const ZoneArrays& z) const {
    team_.template give_back<Vec3r>(x_, z.x.sub(first_vertex_, nv_));
    team_.template give_back<Real>(shortfall_, z.shortfall.sub(first_constraint_, nc_));
    team_.template give_back<Real>(multiplier_, z.multiplier.sub(first_constraint_, nc_));
  }

 private:
  ICLOTH_HD void prepare() {
    // mean(1/m) over the zone makes the weights a_i dimensionless and of order one.
    inverse_mean_ =
        team_.reduce(
            nv_, 0.0, [&](Index i) { return 1.0 / static_cast<double>(mass_[i]); }, Sum{}) /
        static_cast<double>(nv_);
    team_.for_each(nv_, [&](Index i) { direction_[i] = Vec3r{}; });
    value_ = objective(Real(0));
    state_.violation = team_.reduce(
        nc_, -set_.offset, [&](Index j) { return shortfall_[j] = trial_[j]; }, Max{});
  }

  ICLOTH_HD double weight(Index i) const { return static_cast<double>(mass_[i]) * inverse_mean_; }

  ICLOTH_HD Real shortfall_at(Index j, Real step) const {
    const ZoneConstraint& c = constraints_[j];
    Vec3r gap{};
    for (int a = 0; a < 4; ++a) {
      const Index i = c.slot.v[a] - first_vertex_;
      const Vec3r p = c.slot.v[a] == kNone ? fixed_[c.s.v[a]] : x_[i] - step * direction_[i];
      gap += c.s.w[a] * p;
    }
    return set_.offset - dot(c.normal, gap);
  }

  ICLOTH_HD double penalty(Index j, Real shortfall) const {
    const Real t = std::fmax(shortfall + multiplier_[j] / set_.penalty, Real(0));
    return static_cast<double>(Real(0.5) * set_.penalty * t * t);
  }

  /// At x − step · direction; leaves the shortfalls there in `trial`.
  ICLOTH_HD ZoneObjective objective(Real step) const {
    return team_.reduce(
        nc_ + nv_, ZoneObjective{0, 0},
        [&](Index k) {
          if (k < nc_) {
            trial_[k] = shortfall_at(k, step);
            return ZoneObjective{penalty(k, trial_[k]), 0};
          }
          const Index i = k - nc_;
          const Vec3r d = x_[i] - step * direction_[i] - target_[i];
          return ZoneObjective{0, 0.5 * weight(i) * static_cast<double>(norm2(d))};
        },
        Sum{});
  }

  /// Jacobi-preconditioned direction of one vertex (Algorithm 3, line 3); returns its slope.
  ICLOTH_HD double descend(Index i) const {
    const Real a = static_cast<Real>(weight(i));
    Vec3r gradient = a * (x_[i] - target_[i]);
    Real diagonal = a;
    for (Index k = incidence_first_[i]; k < incidence_first_[i + 1]; ++k) {
      const Index j = incidence_[k] / 4 - first_constraint_;
      const ZoneConstraint& c = constraints_[j];
      const Real w = c.s.w[incidence_[k] % 4];
      const Real pull = std::fmax(set_.penalty * shortfall_[j] + multiplier_[j], Real(0));
      gradient -= (w * pull) * c.normal;
      diagonal += set_.penalty * w * w;
    }
    direction_[i] = (Real(1) / diagonal) * gradient;
    return static_cast<double>(dot(gradient, direction_[i]));
  }

  /// Backtracking (Eq. 7) from a whole step on.
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

  /// The minimum keeps the momentum of a zone that touches nothing fixed, but the iteration ends
  /// before, and Jacobi steps do not. Moving the zone back as a whole changes none of its gaps.
  ICLOTH_HD void restore_momentum() const {
    const Index fixed = team_.reduce(
        nc_, Index{0},
        [&](Index j) {
          const Index* slot = constraints_[j].slot.v;
          return slot[0] < 0 || slot[1] < 0 || slot[2] < 0 || slot[3] < 0 ? 1 : 0;
        },
        Sum{});
    if (fixed != 0) return;
    const ZoneMomentum sum = team_.reduce(
        nv_, ZoneMomentum{0, {}},
        [&](Index i) {
          const double mass = static_cast<double>(mass_[i]);
          return ZoneMomentum{mass, mass * convert<double>(x_[i] - target_[i])};
        },
        Sum{});
    const Vec3r shift = convert<Real>((1 / sum.mass) * sum.moved);
    team_.for_each(nv_, [&](Index i) { x_[i] -= shift; });
  }

  Team& team_;
  const ZoneSettings& set_;
  Index first_constraint_, first_vertex_, nc_, nv_;
  View<Vec3r> x_, direction_, before_;
  View<const Vec3r> target_;
  View<const Real> mass_;
  View<Real> shortfall_, trial_, multiplier_;
  View<const ZoneConstraint> constraints_;
  View<const Index> incidence_first_, incidence_;
  View<const Vec3r> fixed_;
  double inverse_mean_ = 0;
  ZoneObjective value_{0, 0};  ///< at x with the present multipliers
  ZoneState state_{0, 0};
};

/// Zones with more active vertices than this are solved by the whole device, one after the other.
inline constexpr Index kLargestTeamZone = 2048;

struct SolveZone {
  ZoneArrays z;
  ZoneSettings set;

  template <class Team>
  ICLOTH_HD void solve(Team& team, Index zone) const {
    ZoneSolver<Team> solver(team, z, set, zone);
    const ZoneResult result = solver.solve();
    solver.give_back(z);
    team.single([&] { z.result[zone] = result; });
  }

  ICLOTH_HD bool is_large(Index zone) const {
    return z.vertex_first[zone + 1] - z.vertex_first[zone] > kLargestTeamZone;
  }
  ICLOTH_HD void operator()(Team& team, Index zone) const {
    if (!is_large(zone)) solve(team, zone);
  }
};

/// Picks the zones that SolveZone leaves.
struct IsLargeZone {
  SolveZone solve;
  ICLOTH_HD bool operator()(Index zone) const { return solve.is_large(zone); }
};

struct SolveLargeZone {
  SolveZone solver;
  Index zone;
  ICLOTH_HD void operator()(DeviceTeam& team) const { solver.solve(team, zone); }
};

}  // namespace icloth::ICLOTH_BUILD
