#include "sim/linear/linear_solver.h"

#include <algorithm>
#include <cmath>

namespace icloth::ICLOTH_BUILD {
namespace {

/// Squared length and sum of a residual.
struct ResidualSums {
  double rr;
  Vec3d sum;
  ICLOTH_HD friend ResidualSums operator+(const ResidualSums& a, const ResidualSums& b) {
    return {a.rr + b.rr, a.sum + b.sum};
  }
};

/// Squared lengths of the right-hand side and of the start.
struct Lengths {
  double bb, xx;
  ICLOTH_HD friend Lengths operator+(Lengths a, Lengths b) { return {a.bb + b.bb, a.xx + b.xx}; }
};

/// The whole solve, for one team: every thread goes through the same iterations and has the same
/// scalars, so that nothing has to be read back in between.
template <class Preconditioner>
struct ConjugateGradients {
  SystemView system;
  Preconditioner precondition;
  View<const Vec3r> b;
  View<Vec3r> x, r, z, p, q;
  View<Vec3r> best;     ///< x of the smallest true residual seen
  View<Vec3r> contact;  ///< H Σ w p of each coupling
  double tolerance;
  int max_iterations;
  View<LinearSolution> solution;  ///< (1)

  /// q = A v; returns v·Av.
  template <class Team>
  ICLOTH_HD double multiply(Team& team, View<const Vec3r> v) const {
    if (contact.size() > 0) {
      team.for_each(contact.size(), [&](Index c) {
        Vec3r sum{};
        const Coupling& coupling = system.couplings.list[c];
        const Stencil& s = coupling.s;
        for (int a = 0; a < 4; ++a)
          if (s.v[a] < b.size()) sum += s.w[a] * v[s.v[a]];
        contact[c] = coupling.h * sum;
      });
    }
    return team.reduce(
        b.size(), 0.0,
        [&](Index i) {
          if (!(system.inverse_mass[i] > 0)) {
            q[i] = Vec3r{};
            return 0.0;
          }
          Vec3r sum = multiply_row(system, i, &v.data()->x);
          system.couplings.of_vertex(i, [&](Index c, Real w) { sum += w * contact[c]; });
          q[i] = sum;
          return dot_double(v[i], sum);
        },
        Sum{});
  }

  /// Row i of r = b − A x; q is A x.
  ICLOTH_HD Vec3r true_residual(Index i) const {
    return r[i] = system.inverse_mass[i] > 0 ? b[i] - q[i] : Vec3r{};
  }

  template <class Team>
  ICLOTH_HD ResidualSums true_residuals(Team& team) const {
    multiply(team, x);
    return team.reduce(
        b.size(), ResidualSums{},
        [&](Index i) {
          const Vec3r residual = true_residual(i);
          return ResidualSums{dot_double(residual, residual), convert<double>(residual)};
        },
        Sum{});
  }

  template <class Team>
  ICLOTH_HD void operator()(Team& team) const {
    const Index n = b.size();
    const Lengths lengths = team.reduce(
        n, Lengths{0, 0},
        [&](Index i) {
          return Lengths{dot_double(b[i], b[i]), dot_double(x[i], x[i])};
        },
        Sum{});
    LinearSolution result;
    if (lengths.bb != 0) result = iterate(team, lengths);
    // No numbers in, no numbers out: an x that merely stayed zero would pass for a solution.
    if (!(result.residual - result.residual == 0))
      team.for_each(n, [&](Index i) { x[i].x = static_cast<Real>(NAN); });
    team.single([&] { solution[0] = result; });
  }

  template <class Team>
  ICLOTH_HD LinearSolution iterate(Team& team, Lengths lengths) const {
    constexpr int kReplaceEvery = 50;  // iterations between true residuals
    constexpr int kPatience = 40;      // true residuals in a row without gain: rounding rules
    const Index n = b.size();
    const double bb = lengths.bb;
    LinearSolution result;
    if (lengths.xx == 0)  // a product saved
      team.for_each(n, [&](Index i) { q[i] = Vec3r{}; });
    else
      multiply(team, x);
    Dots dots = precondition(
        team, [&](Index i) { return true_residual(i); }, r, z);
    team.for_each(n, [&](Index i) { p[i] = z[i], best[i] = x[i]; });
    double best_rr = dots.rr;
    int idle = 0;
    while (result.iterations < max_iterations && dots.rr > tolerance * tolerance * bb) {
      const double pq = multiply(team, p.sub(0, n));
      if (!(pq > 0) || !(dots.rz > 0)) break;  // rounding has eaten the curvature, or NaN
      const double rz = dots.rz;
      const Real alpha = static_cast<Real>(rz / pq);
      if (++result.iterations % kReplaceEvery == 0) {
        team.for_each(n, [&](Index i) { x[i] += alpha * p[i]; });
        multiply(team, x);
        dots = precondition(
            team, [&](Index i) { return true_residual(i); }, r, z);
        if (dots.rr < best_rr) {
          best_rr = dots.rr, idle = 0;
          team.for_each(n, [&](Index i) { best[i] = x[i]; });
        } else if (++idle == kPatience) {
          break;
        }
      } else {
        dots = precondition(
            team,
            [&](Index i) {
              x[i] += alpha * p[i];
              return r[i] -= alpha * q[i];
            },
            r, z);
      }
      const Real beta = static_cast<Real>(dots.rz / rz);
      team.for_each(n, [&](Index i) { p[i] = z[i] + beta * p[i]; });
    }
    ResidualSums end = true_residuals(team);
    // In single precision a very stiff system can run away from the solution.
    if (!(end.rr <= best_rr)) {
      team.for_each(n, [&](Index i) { x[i] = best[i]; });
      end = true_residuals(team);
    }
    result.residual = std::sqrt(end.rr / bb);
    result.lost = end.sum;
    return result;
  }
};

/// What one iteration has to read and write when every number is moved once: the blocks and their
/// places, the contacts, and 15 vectors and a block for each row.
double bytes_per_iteration(const SystemView& system, Index rows) {
  const double blocks = system.column.size(), others = system.lower_column.size();
  return blocks * (9 * sizeof(Real) + sizeof(Index)) + 2 * sizeof(Index) * others +
         static_cast<double>(system.couplings.size()) *
             (sizeof(Coupling) + 4 * sizeof(Index) + 2 * sizeof(Vec3r)) +
         static_cast<double>(rows) *
             (15 * sizeof(Vec3r) + sizeof(Mat3r) + sizeof(Real) + 3 * sizeof(Index));
}

/// The residual that the iterations carry along differs from the true one by rounding.
constexpr double kMissed = 1.5;

}  // namespace

LinearSolution LinearSolver::solve(const SystemView& system, View<const Mat3r> inverse_diagonal,
                                   View<const Vec3r> b, View<Vec3r> padded,
                                   const SolveOptions& options) {
  const Index n = b.size(), couplings = system.couplings.size();
  for (Array<Vec3r>* a : {&r_, &z_, &p_, &q_, &best_}) a->resize(n + kPadding);
  contact_.resize(couplings);
  solution_.resize(1);
  const auto iterate = [&](const auto& preconditioner, int max_iterations) {
    with_device_team(
        "implicit.solve", std::max(n, couplings),
        ConjugateGradients<std::decay_t<decltype(preconditioner)>>{.system = system,
                                                                   .precondition = preconditioner,
                                                                   .b = b,
                                                                   .x = padded.sub(0, n),
                                                                   .r = r_.view().sub(0, n),
                                                                   .z = z_.view().sub(0, n),
                                                                   .p = p_.view(),
                                                                   .q = q_.view(),
                                                                   .best = best_.view(),
                                                                   .contact = contact_.view(),
                                                                   .tolerance = options.tolerance,
                                                                   .max_iterations = max_iterations,
                                                                   .solution = solution_.view()});
  };
  const auto finish = [&] {
    LinearSolution solution;
    solution_.download_range(0, {&solution, 1});
    return solution;
  };
  const double bytes = bytes_per_iteration(system, n);
  LinearSolution coarse;
  if (options.preconditioner == Preconditioner::multilevel) {
    if (!options.same_matrix) hierarchy_.fill_matrix(system);
    hierarchy_.fill_contacts(system);
    iterate(hierarchy_.view(system, inverse_diagonal), options.max_iterations);
    coarse = finish();
    coarse.bytes = coarse.iterations * (bytes + hierarchy_.bytes());
    // Where rounding hides the masses in the sums of a level, block-Jacobi gets further.
    if (!(coarse.residual > kMissed * options.tolerance) ||
        coarse.iterations >= options.max_iterations)
      return coarse;
  }
  iterate(BlockJacobi{inverse_diagonal}, options.max_iterations - coarse.iterations);
  LinearSolution solution = finish();
  solution.bytes = coarse.bytes + solution.iterations * bytes;
  solution.iterations += coarse.iterations;
  return solution;
}

}  // namespace icloth::ICLOTH_BUILD
