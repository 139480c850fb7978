// The linear solver of an impact zone: inelastic projection (Harmon, Vouga, Tamstorf, Grinspun
// 2008), the baseline of the paper's Fig. 10.
//
//   J x = d,  d_j = max(n·g at the start of the step, δ):   (J a⁻¹ Jᵀ) λ = d − J x*
//
// The relative normal velocity of every pair is zero after it: constraints may also pull, which
// makes layers stick. The system is solved by conjugate gradients.
#pragma once

#include "kernels/zones/zone_problem.h"

namespace icloth::ICLOTH_BUILD {

/// The linear solver; the head of this file has the method.
template <class Team>
class ZoneLinear : public ZoneProblem<Team> {
 public:
  using Base = ZoneProblem<Team>;
  using Base::Base;

  /// Iterates until no constraint is off by more than a fifth of δ. Returns the number of
  /// iterations.
  ICLOTH_HD int solve() {
    Norms norms = start();
    int k = 0;
    for (; k < set_.iterations && norms.largest > set_.tolerance; ++k) {
      // The product q = J a⁻¹ Jᵀ p is made in two halves, of which the first is u = a⁻¹ Jᵀ p.
      team_.for_each(nv_, [&](Index i) {
        Vec3r sum{};
        this->for_constraints(
            i, [&](Index j, Real w) { sum += (w * p_[j]) * constraints_[j].normal; });
        direction_[i] = (Real(1) / static_cast<Real>(this->weight(i))) * sum;
      });
      const double pq = team_.reduce(
          nc_, 0.0,
          [&](Index j) {
            q_[j] = dot(constraints_[j].normal, gap_vector(j, direction_));
            return static_cast<double>(p_[j]) * static_cast<double>(q_[j]);
          },
          Sum{});

      // Without curvature along p the rest of the residual cannot be removed. Otherwise this is the
      // step of conjugate gradients along p.
      if (!(pq > 0)) break;
      const Real alpha = static_cast<Real>(norms.square / pq);
      const double before = norms.square;
      norms = team_.reduce(
          nc_, Norms{0, 0},
          [&](Index j) {
            multiplier_[j] += alpha * p_[j];
            r_[j] -= alpha * q_[j];
            return norms_of(j);
          },
          CombineNorms{});

      // The next direction is conjugate to the last one.
      const Real beta = static_cast<Real>(norms.square / before);
      team_.for_each(nc_, [&](Index j) { p_[j] = r_[j] + beta * p_[j]; });
    }

    // The positions follow from the multipliers: x = x* + a⁻¹ Jᵀ λ.
    team_.for_each(nv_, [&](Index i) {
      Vec3r sum{};
      this->for_constraints(
          i, [&](Index j, Real w) { sum += (w * multiplier_[j]) * constraints_[j].normal; });
      x_[i] = target_[i] + (Real(1) / static_cast<Real>(this->weight(i))) * sum;
    });
    return k;
  }

 private:
  using Base::constraints_, Base::direction_, Base::multiplier_, Base::nc_, Base::nv_, Base::set_,
      Base::start_, Base::target_, Base::team_, Base::x_;
  View<Real> r_ = Base::shortfall_;  ///< residual d − J x; its memory is free until finish()
  View<Real> p_ = Base::scratch1_;   ///< search direction
  View<Real> q_ = Base::scratch2_;   ///< J a⁻¹ Jᵀ p

  /// The residual: the sum of its squares, and its largest entry [m].
  struct Norms {
    double square;
    Real largest;
  };
  struct CombineNorms {
    ICLOTH_HD Norms operator()(Norms a, Norms b) const {
      return {a.square + b.square, Max{}(a.largest, b.largest)};
    }
  };

  /// The gap vector Σ w u over the free corners.
  ICLOTH_HD Vec3r gap_vector(Index j, View<const Vec3r> u) const {
    Vec3r sum{};
    for (int a = 0; a < 4; ++a) {
      const Index i = this->corner(j, a);
      if (i >= 0) sum += constraints_[j].s.w[a] * u[i];
    }
    return sum;
  }

  ICLOTH_HD Norms norms_of(Index j) const {
    const double r = static_cast<double>(r_[j]);
    return {r * r, std::fabs(r_[j])};
  }

  /// Starts from λ = 0, where p = r = d − J x*.
  ICLOTH_HD Norms start() const {
    return team_.reduce(
        nc_, Norms{0, 0},
        [&](Index j) {
          const ZoneConstraint& c = constraints_[j];
          const Real at_start = dot(c.normal, apply(c.s, start_));
          const Real missing =
              this->shortfall_at(j, [&](Index i) -> const Vec3r& { return target_[i]; });
          multiplier_[j] = 0;
          r_[j] = missing + std::fmax(at_start - c.offset, Real(0));
          p_[j] = r_[j];
          return norms_of(j);
        },
        CombineNorms{});
  }
};

}  // namespace icloth::ICLOTH_BUILD
