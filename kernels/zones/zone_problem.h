// An impact zone as a problem for a team: the quantities that every solver of zones reads, writes
// and reports.
//
//   minimise ½ Σ a_i |x_i − x*_i|²  subject to  n_j·g_j(x) ≥ δ
//
// Deviations from Eq. 1 and 2 of the paper: every impact keeps an offset δ; a_i = m_i · mean(1/m)
// over the zone instead of 2 m_i / Σm, which makes the numbers independent of the size of the zone
// (the scaling of ARCSim). Multipliers are in metres: those of an impulse, times mean(1/m).
#pragma once

#include "kernels/parallel/parallel.h"
#include "kernels/stencil.h"

namespace icloth::ICLOTH_BUILD {

/// One constraint n·g(x) ≥ δ of a zone.
struct ZoneConstraint {
  Stencil s;     ///< obstacle vertices included
  Int4 slot;     ///< active vertex number of each corner, kNone where it cannot move
  Vec3r normal;  ///< towards the side of the start
  Real offset;   ///< δ [m]
};

struct ZoneSettings {
  Real offset;          ///< the usual δ [m]
  Real tolerance;       ///< of a gap [m]: a fifth of δ
  int iterations;       ///< at most
  Real penalty;         ///< μ, of the augmented Lagrangian
  Real rho;             ///< ρ of its Chebyshev step
  Real step_threshold;  ///< its smallest step length
  bool chebyshev;
};

/// The distance of the end of a solve from the conditions of an optimum (Karush, Kuhn and Tucker).
struct ZoneResult {
  Index iterations;
  Real violation;        ///< largest δ − n·g, 0 if none [m]
  Real complementarity;  ///< largest of min(λ, n·g − δ), and of −λ [m]
  /// |Σ a (x − x*) − Σ λ n of what cannot move| / Σ a |x − x*|: the momentum that is not balanced.
  Real momentum_residual;
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
  View<const Vec3r> start;             ///< start-of-step positions of all vertices [m]
  View<Vec3r> x;                       ///< start, then result [m] (active vertices)
  View<Vec3r> before, direction;       ///< each solver gives them a meaning of its own [m] (active)
  View<Real> multiplier;               ///< λ_j: last round's, then the result [m] (constraints)
  View<Real> shortfall;                ///< δ − n·g(x) of the result [m] (constraints)
  View<Real> scratch1, scratch2;  ///< each solver gives them a meaning of its own (constraints)
  View<ZoneResult> result;        ///< (zones)
};

/// One zone's share of the buffers, with vertices and constraints numbered within the zone. The
/// buffers that are read and written all the time are borrowed, which puts them into shared memory
/// on CUDA.
template <class Team>
class ZoneProblem {
 public:
  ICLOTH_HD ZoneProblem(Team& team, const ZoneArrays& z, const ZoneSettings& set, Index zone)
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
        multiplier_(team.borrow(z.multiplier.sub(first_constraint_, nc_))),
        shortfall_(team.borrow(z.shortfall.sub(first_constraint_, nc_))),
        scratch1_(team.borrow(z.scratch1.sub(first_constraint_, nc_))),
        scratch2_(team.borrow(z.scratch2.sub(first_constraint_, nc_))),
        constraints_(team.borrow(z.constraints.sub(first_constraint_, nc_))),
        incidence_first_(z.incidence_first.sub(first_vertex_, nv_ + 1)),
        incidence_(z.incidence),
        fixed_(z.fixed),
        start_(z.start) {
    // mean(1/m) over the zone makes the weights a_i dimensionless and of order one.
    inverse_mean_ =
        team_.reduce(
            nv_, 0.0, [&](Index i) { return 1.0 / static_cast<double>(mass_[i]); }, Sum{}) /
        static_cast<double>(nv_);
  }

  /// Writes the result to where it was borrowed from and says how good it is.
  ICLOTH_HD void finish(const ZoneArrays& z, Index zone, int iterations) {
    const ZoneResult result = residuals(iterations);
    team_.template give_back<Vec3r>(x_, z.x.sub(first_vertex_, nv_));
    team_.template give_back<Real>(shortfall_, z.shortfall.sub(first_constraint_, nc_));
    team_.template give_back<Real>(multiplier_, z.multiplier.sub(first_constraint_, nc_));
    team_.single([&] { z.result[zone] = result; });
  }

 protected:
  /// a_i
  ICLOTH_HD double weight(Index i) const { return static_cast<double>(mass_[i]) * inverse_mean_; }

  /// Corner `a` of constraint j within the zone, negative where it cannot move.
  ICLOTH_HD Index corner(Index j, int a) const {
    const Index slot = constraints_[j].slot.v[a];
    return slot == kNone ? kNone : slot - first_vertex_;
  }

  /// δ − n·g with the free vertices at position(i).
  template <class Position>
  ICLOTH_HD Real shortfall_at(Index j, const Position& position) const {
    const ZoneConstraint& c = constraints_[j];
    Vec3r gap{};
    for (int a = 0; a < 4; ++a) {
      const Index i = corner(j, a);
      gap += c.s.w[a] * (i < 0 ? fixed_[c.s.v[a]] : position(i));
    }
    return c.offset - dot(c.normal, gap);
  }

  /// Calls visit(j, w) for every constraint of vertex i, w its weight there.
  template <class Visit>
  ICLOTH_HD void for_constraints(Index i, const Visit& visit) const {
    for (Index k = incidence_first_[i]; k < incidence_first_[i + 1]; ++k) {
      const Index j = incidence_[k] / 4 - first_constraint_;
      visit(j, constraints_[j].s.w[incidence_[k] % 4]);
    }
  }

  /// The minimum keeps the momentum of a zone that touches nothing fixed, but an iteration ends
  /// before, and not every step keeps it. Moving the zone back as a whole changes no gap.
  ICLOTH_HD void restore_momentum() const {
    // A zone that touches something fixed may exchange momentum with it.
    const Index fixed = team_.reduce(
        nc_, Index{0},
        [&](Index j) {
          return corner(j, 0) < 0 || corner(j, 1) < 0 || corner(j, 2) < 0 || corner(j, 3) < 0;
        },
        Sum{});
    if (fixed != 0) return;

    // The rest of the momentum goes to all vertices in equal displacements.
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
  View<Real> multiplier_;
  View<Real> shortfall_;            ///< finish() writes it last, so a solver may use it as scratch
  View<Real> scratch1_, scratch2_;  ///< one number a constraint, for a solver to name
  View<const ZoneConstraint> constraints_;
  View<const Index> incidence_first_, incidence_;
  View<const Vec3r> fixed_, start_;
  double inverse_mean_ = 0;

 private:
  struct Residuals {
    Real violation, complementarity;
  };
  struct LargerResiduals {
    ICLOTH_HD Residuals operator()(Residuals a, Residuals b) const {
      return {Max{}(a.violation, b.violation), Max{}(a.complementarity, b.complementarity)};
    }
  };
  /// The sum of the moved momentum less what the constraints gave, and of its absolute values.
  struct Balance {
    Vec3d left;
    double moved;
    ICLOTH_HD friend Balance operator+(Balance a, Balance b) {
      return {a.left + b.left, a.moved + b.moved};
    }
  };

  /// Measures how far x and λ are from an optimum, and leaves the shortfalls of the result.
  ICLOTH_HD ZoneResult residuals(int iterations) const {
    // Primal feasibility and complementarity are measured constraint by constraint.
    const Residuals r = team_.reduce(
        nc_, Residuals{0, 0},
        [&](Index j) {
          const Real s = shortfall_[j] =
              shortfall_at(j, [&](Index i) -> const Vec3r& { return x_[i]; });
          const Real slack = std::fmax(-s, Real(0));
          return Residuals{s, std::fmax(std::fmin(multiplier_[j], slack), -multiplier_[j])};
        },
        LargerResiduals{});

    // The balance of momentum compares the displacement of the vertices with the impulses of the
    // constraints. Corners that cannot move take impulses that do not count.
    const Balance b = team_.reduce(
        nv_ + nc_, Balance{{}, 0},
        [&](Index k) {
          if (k < nv_) {
            const Vec3d moved = weight(k) * convert<double>(x_[k] - target_[k]);
            return Balance{moved, norm(moved)};
          }
          Real given = 0;
          for (int a = 0; a < 4; ++a)
            if (corner(k - nv_, a) >= 0) given += constraints_[k - nv_].s.w[a];
          const Vec3r impulse = (given * multiplier_[k - nv_]) * constraints_[k - nv_].normal;
          return Balance{-1.0 * convert<double>(impulse), 0};
        },
        Sum{});

    const double momentum = b.moved > 0 ? norm(b.left) / b.moved : 0;
    return {static_cast<Index>(iterations), r.violation, r.complementarity,
            static_cast<Real>(momentum)};
  }
};

}  // namespace icloth::ICLOTH_BUILD
