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
  View<Real> slope;                    ///< gradient · direction of each active vertex
  View<Real> multiplier, shortfall, trial;  ///< λ_j, c_j = δ − n·g(x), c_j at the trial point
  View<ZoneResult> result;                  ///< (zones)
};

struct SolveZone {
  ZoneArrays z;
  ZoneSettings set;

  ICLOTH_HD Real shortfall_of(Index j, Real step) const {
    const ZoneConstraint& c = z.constraints[j];
    Vec3r gap{};
    for (int a = 0; a < 4; ++a) {
      const Index i = c.slot.v[a];
      const Vec3r p = i == kNone ? z.fixed[c.s.v[a]] : z.x[i] - step * z.direction[i];
      gap += c.s.w[a] * p;
    }
    return set.offset - dot(c.normal, gap);
  }

  ICLOTH_HD Real penalty_term(Index j, Real shortfall) const {
    const Real t = std::fmax(shortfall + z.multiplier[j] / set.penalty, Real(0));
    return Real(0.5) * set.penalty * t * t;
  }

  /// Gradient, Jacobi-preconditioned direction and slope of one vertex (Algorithm 3, line 3).
  ICLOTH_HD void descend(Index i, Real weight) const {
    Vec3r gradient = weight * (z.x[i] - z.target[i]);
    Real diagonal = weight;
    for (Index k = z.incidence_first[i]; k < z.incidence_first[i + 1]; ++k) {
      const Index j = z.incidence[k] / 4;
      const ZoneConstraint& c = z.constraints[j];
      const Real w = c.s.w[z.incidence[k] % 4];
      const Real pull = std::fmax(set.penalty * z.shortfall[j] + z.multiplier[j], Real(0));
      gradient -= (w * pull) * c.normal;
      diagonal += set.penalty * w * w;
    }
    z.direction[i] = (Real(1) / diagonal) * gradient;
    z.slope[i] = dot(gradient, z.direction[i]);
  }

  /// ω of Eq. 8 after k iterations since the last start.
  ICLOTH_HD Real chebyshev_weight(int k, Real last) const {
    const Real rho2 = set.rho * set.rho;
    return k < 10 ? Real(1) : (k == 10 ? 2 / (2 - rho2) : 4 / (4 - rho2 * last));
  }

  template <class Team>
  ICLOTH_HD double objective(Team& team, Index zone, double inverse_mean, Real step) const {
    const Index c0 = z.constraint_first[zone], c1 = z.constraint_first[zone + 1];
    const Index v0 = z.vertex_first[zone], v1 = z.vertex_first[zone + 1];
    const double penalties = team.reduce(
        c1 - c0, 0.0,
        [&](Index k) {
          z.trial[c0 + k] = shortfall_of(c0 + k, step);
          return static_cast<double>(penalty_term(c0 + k, z.trial[c0 + k]));
        },
        Sum{});
    const double distance = team.reduce(
        v1 - v0, 0.0,
        [&](Index k) {
          const Index i = v0 + k;
          const Vec3r d = z.x[i] - step * z.direction[i] - z.target[i];
          return static_cast<double>(z.mass[i]) * inverse_mean * static_cast<double>(norm2(d));
        },
        Sum{});
    return penalties + 0.5 * distance;
  }

  /// The minimum keeps the momentum of a zone that touches nothing fixed, but the iteration ends
  /// before, and Jacobi steps do not. Moving the zone back as a whole changes none of its gaps.
  template <class Team>
  ICLOTH_HD void restore_momentum(Team& team, Index zone) const {
    const Index c0 = z.constraint_first[zone], v0 = z.vertex_first[zone];
    const Index count = z.vertex_first[zone + 1] - v0;
    const Index fixed = team.reduce(
        z.constraint_first[zone + 1] - c0, Index{0},
        [&](Index k) {
          const Index* slot = z.constraints[c0 + k].slot.v;
          return slot[0] < 0 || slot[1] < 0 || slot[2] < 0 || slot[3] < 0 ? 1 : 0;
        },
        Sum{});
    if (fixed != 0) return;
    const ZoneMomentum sum = team.reduce(
        count, ZoneMomentum{0, {}},
        [&](Index k) {
          const double mass = static_cast<double>(z.mass[v0 + k]);
          const Vec3d moved = convert<double>(z.x[v0 + k] - z.target[v0 + k]);
          return ZoneMomentum{mass, mass * moved};
        },
        Sum{});
    const Vec3r shift = convert<Real>((1 / sum.mass) * sum.moved);
    team.for_each(count, [&](Index k) { z.x[v0 + k] -= shift; });
  }

  template <class Team>
  ICLOTH_HD void operator()(Team& team, Index zone) const {
    const Index c0 = z.constraint_first[zone], nc = z.constraint_first[zone + 1] - c0;
    const Index v0 = z.vertex_first[zone], nv = z.vertex_first[zone + 1] - v0;
    // mean(1/m) over the zone makes the weights a_i dimensionless and of order one.
    const double inverse_mean =
        team.reduce(
            nv, 0.0, [&](Index k) { return 1.0 / static_cast<double>(z.mass[v0 + k]); }, Sum{}) /
        static_cast<double>(nv);
    team.for_each(nv, [&](Index k) { z.direction[v0 + k] = Vec3r{}; });
    double value = objective(team, zone, inverse_mean, Real(0));
    team.for_each(nc, [&](Index k) { z.shortfall[c0 + k] = z.trial[c0 + k]; });

    Real omega = 1, violation = 0;
    int k = 0, since_restart = 0;
    for (; k < set.iterations; ++k) {
      violation = team.reduce(
          nc, Real(0), [&](Index j) { return z.shortfall[c0 + j]; }, Max{});
      if (violation <= Real(0.2) * set.offset) break;

      team.for_each(nv, [&](Index i) {
        descend(v0 + i, static_cast<Real>(static_cast<double>(z.mass[v0 + i]) * inverse_mean));
      });
      const double slope = team.reduce(
          nv, 0.0, [&](Index i) { return static_cast<double>(z.slope[v0 + i]); }, Sum{});

      // Backtracking line search (Eq. 7).
      Real step = 1;
      double trial = objective(team, zone, inverse_mean, step);
      for (int halvings = 0;
           halvings < 12 && !(trial <= value - 1e-4 * static_cast<double>(step) * slope);
           ++halvings) {
        step *= Real(0.5);
        trial = objective(team, zone, inverse_mean, step);
      }
      if (step * static_cast<Real>(std::sqrt(slope)) < set.step_threshold) break;

      if (!set.chebyshev || step < 1) since_restart = 0;
      omega = chebyshev_weight(since_restart++, omega);
      team.for_each(nv, [&](Index n) {
        const Index i = v0 + n;
        const Vec3r old = z.x[i], next = old - step * z.direction[i];
        z.x[i] = omega == 1 ? next : z.before[i] + omega * (next - z.before[i]);
        z.direction[i] = next - z.x[i];  // leads back from the accelerated point
        z.before[i] = old;
      });
      // Acceleration may overshoot where constraints switch on and off: then it starts again.
      if (omega != 1 && !(objective(team, zone, inverse_mean, Real(0)) <= trial)) {
        team.for_each(nv, [&](Index n) { z.x[v0 + n] += z.direction[v0 + n]; });
        since_restart = 0;
      }
      objective(team, zone, inverse_mean, Real(0));  // shortfalls at the new iterate
      team.for_each(nc, [&](Index n) {
        const Index j = c0 + n;
        z.shortfall[j] = z.trial[j];
        z.multiplier[j] = std::fmax(set.penalty * z.shortfall[j] + z.multiplier[j], Real(0));
      });
      value = objective(team, zone, inverse_mean, Real(0));
    }
    restore_momentum(team, zone);
    team.single([&] { z.result[zone] = {static_cast<Index>(k), violation}; });
  }
};

}  // namespace icloth::ICLOTH_BUILD
