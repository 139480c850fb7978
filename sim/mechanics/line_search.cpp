#include "sim/mechanics/line_search.h"

#include <algorithm>
#include <cmath>

namespace icloth::ICLOTH_BUILD {
namespace {

/// The slope of the energy is small enough when it is this share of that at the start.
constexpr double kSlopeLeft = 0.1;
constexpr int kTrials = 8;

/// A pair of sums.
struct Two {
  double first, second;
  ICLOTH_HD friend Two operator+(Two a, Two b) { return {a.first + b.first, a.second + b.second}; }
};

/// The whole search, for one team. Every thread goes through the same trials.
struct Search {
  SystemView system;
  ContactLine line;
  View<const Coupling> seams;
  SearchDirection direction;
  View<Vec3r> dv, residual;
  View<Vec3r> product, along;
  View<Index> closed;
  View<double> share;

  template <class Team>
  ICLOTH_HD void operator()(Team& team) const {
    const Index vertices = product.size(), contacts = line.contacts.size();
    Two quadratic = sums_without_contacts(team);
    if (seams.size() > 0) quadratic = quadratic + sums_of_seams(team);
    const double alpha = contacts == 0 ? 1 : minimum(team, quadratic);
    const Real step = static_cast<Real>(alpha);
    team.for_each(vertices, [&](Index i) {
      dv[i] += step * direction.d[i];
      residual[i] -= step * product[i];
    });
    team.for_each(contacts, [&](Index k) { line.travels[k].end += step * along[k]; });
    team.single([&] { share[0] = alpha; });
  }

  /// d·A d and d·(b − A Δv) without couplings; sets `product` to A d.
  template <class Team>
  ICLOTH_HD Two sums_without_contacts(Team& team) const {
    return team.reduce(
        product.size(), Two{0, 0},
        [&](Index i) {
          Vec3r sum = direction.product[i];
          system.couplings.of_vertex(i, [&](Index c, Real w) { sum -= w * direction.coupling[c]; });
          if (!(system.inverse_mass[i] > 0)) sum = Vec3r{};
          product[i] = sum;
          const Vec3r d = direction.d[i];
          return Two{dot_double(d, sum), dot_double(d, residual[i])};
        },
        Sum{});
  }

  /// The same of the springs of open seams, which are linear and act in every pass.
  template <class Team>
  ICLOTH_HD Two sums_of_seams(Team& team) const {
    return team.reduce(
        seams.size(), Two{0, 0},
        [&](Index k) {
          const Coupling& seam = seams[k];
          const Vec3r change = seam.of_cloth(direction.d, product.size());
          const Vec3r now = seam.of_cloth(dv, product.size());
          return Two{dot_double(change, seam.h * change),
                     dot_double(change, seam.impulse - seam.h * now)};
        },
        Sum{});
  }

  /// α at which the slope of the energy is small, by regula falsi and bisection in turns.
  template <class Team>
  ICLOTH_HD double minimum(Team& team, Two quadratic) const {
    // A gap is linear in α: a contact that is open at both ends stays open.
    const Index contacts = line.contacts.size();
    const Two ends = team.reduce(
        contacts, Two{0, 0},
        [&](Index k) {
          const Contact& c = line.contacts[k];
          const Vec3r from = line.travels[k].end, change = line.motion.along(c, direction.d);
          along[k] = change;
          closed[k] = end_gap(c, from) < c.thickness || end_gap(c, from + change) < c.thickness;
          if (closed[k] == 0) return Two{0, 0};
          return Two{work(k, 0), work(k, 1)};
        },
        Sum{});
    const double start = -quadratic.second - ends.first;
    const double end = quadratic.first - quadratic.second - ends.second;
    if (!(start < 0) || !(end > -kSlopeLeft * start)) return 1;

    // The slope is below zero at `low` and above at `high`.
    double low = 0, high = 1, below = start, above = end, alpha = 1;
    for (int trial = 0; trial < kTrials; ++trial) {
      alpha = trial % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * below / (below - above);
      const Real step = static_cast<Real>(alpha);
      const double contact_work = team.reduce(
          contacts, 0.0, [&](Index k) { return closed[k] != 0 ? work(k, step) : 0; }, Sum{});
      const double slope = alpha * quadratic.first - quadratic.second - contact_work;
      if (std::fabs(slope) < -kSlopeLeft * start) break;
      (slope > 0 ? high : low) = alpha;
      (slope > 0 ? above : below) = slope;
    }
    return alpha;
  }

  /// Work of the contact law's force at α along the whole direction [J].
  ICLOTH_HD double work(Index k, Real alpha) const {
    const Contact& c = line.contacts[k];
    const Vec3r end = line.travels[k].end + alpha * along[k];
    const Real normal = normal_force(c, line.law, end);
    if (!(normal > 0)) return 0;
    Vec3r force = normal * c.normal;
    if (c.friction > 0) force += friction_of(c, line.law, end, normal).force;
    return dot_double(force, along[k]);
  }
};

}  // namespace

double LineSearch::go(const SystemView& system, const ContactLine& line, View<const Coupling> seams,
                      const SearchDirection& direction, View<Vec3r> dv, View<Vec3r> residual) {
  const Index vertices = residual.size(), contacts = line.contacts.size();
  product_.resize(vertices);
  along_.resize(contacts);
  closed_.resize(contacts);
  share_.resize(1);
  with_device_team("implicit.line_search", std::max({vertices, contacts, seams.size()}),
                   Search{.system = system,
                          .line = line,
                          .seams = seams,
                          .direction = direction,
                          .dv = dv,
                          .residual = residual,
                          .product = product_.view(),
                          .along = along_.view(),
                          .closed = closed_.view(),
                          .share = share_.view()});
  double share = 1;
  share_.download_range(0, {&share, 1});
  return share;
}

}  // namespace icloth::ICLOTH_BUILD
