#include "sim/linear/linear_solver.h"

#include <algorithm>
#include <cmath>

namespace icloth::ICLOTH_BUILD {
namespace {

/// The squared length and the sum of a residual.
struct ResidualSums {
  double rr;
  Vec3d sum;
  ICLOTH_HD friend ResidualSums operator+(const ResidualSums& a, const ResidualSums& b) {
    return {a.rr + b.rr, a.sum + b.sum};
  }
};

/// The squared lengths of the right-hand side and of the start.
struct Lengths {
  double bb, xx;
  ICLOTH_HD friend Lengths operator+(Lengths a, Lengths b) { return {a.bb + b.bb, a.xx + b.xx}; }
};

/// The whole solve by preconditioned conjugate gradients, for one team. Every thread goes through
/// the same iterations and has the same scalars, so that nothing has to be read back in between.
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

  /// Sets q = A v and adds up of_row(i), a T, over its rows.
  template <class T, class Team, class OfRow>
  ICLOTH_HD T multiply(Team& team, View<const Vec3r> v, const OfRow& of_row) const {
    // Contacts are applied in two halves, first H Σ w v of each coupling, so that a vertex can
    // gather them in a fixed order.
    if (contact.size() > 0) {
      team.for_each(contact.size(), [&](Index c) {
        const Coupling& coupling = system.couplings.list[c];
        contact[c] = coupling.h * coupling.of_cloth(v, b.size());
      });
    }

    // Each row gathers its blocks and its contacts; prescribed vertices have no row.
    return team.reduce(
        b.size(), T{},
        [&](Index i) {
          Vec3r sum{};
          if (system.inverse_mass[i] > 0) {
            sum = multiply_row(system, i, &v.data()->x);
            system.couplings.of_vertex(i, [&](Index c, Real w) { sum += w * contact[c]; });
          }
          q[i] = sum;
          return of_row(i);
        },
        Sum{});
  }

  /// Row i of r = b − A x, where q is A x.
  ICLOTH_HD Vec3r true_residual(Index i) const {
    return r[i] = system.inverse_mass[i] > 0 ? b[i] - q[i] : Vec3r{};
  }

  /// The true residual of x, summed up.
  template <class Team>
  ICLOTH_HD ResidualSums true_residuals(Team& team) const {
    return multiply<ResidualSums>(team, x, [&](Index i) {
      const Vec3r residual = true_residual(i);
      return ResidualSums{dot_double(residual, residual), convert<double>(residual)};
    });
  }

  /// Goes by α p and carries the residual along; q is A p.
  template <class Team>
  ICLOTH_HD Dots step_along(Team& team, Real alpha) const {
    return precondition(
        team,
        [&](Index i) {
          x[i] += alpha * p[i];
          return r[i] -= alpha * q[i];
        },
        r, z);
  }

  /// Goes by α p and computes the residual anew.
  template <class Team>
  ICLOTH_HD Dots step_anew(Team& team, Real alpha) const {
    team.for_each(b.size(), [&](Index i) { x[i] += alpha * p[i]; });
    true_residuals(team);
    return precondition(
        team, [&](Index i) { return r[i]; }, r, z);
  }

  template <class Team>
  ICLOTH_HD void operator()(Team& team) const {
    const Index n = b.size();

    // Both lengths decide how to begin: without a right-hand side the solution is zero.
    const Lengths lengths = team.reduce(
        n, Lengths{0, 0},
        [&](Index i) {
          return Lengths{dot_double(b[i], b[i]), dot_double(x[i], x[i])};
        },
        Sum{});
    LinearSolution result;
    if (lengths.bb != 0) result = iterate(team, lengths);

    // Without numbers in there are no numbers out: an x that merely stayed zero would pass for a
    // solution.
    if (!(result.residual - result.residual == 0))
      team.for_each(n, [&](Index i) { x[i].x = static_cast<Real>(NAN); });
    team.single([&] { solution[0] = result; });
  }

  /// Iterates from x, whatever it holds, and leaves the best x that was seen.
  template <class Team>
  ICLOTH_HD LinearSolution iterate(Team& team, Lengths lengths) const {
    constexpr int kReplaceEvery = 50;  // iterations between true residuals
    constexpr int kPatience = 40;      // true residuals in a row without gain: rounding rules
    const Index n = b.size();
    const double bb = lengths.bb;

    // The first residual is b when the start is zero, which saves a product.
    LinearSolution result;
    const bool starts_at_zero = lengths.xx == 0;
    if (!starts_at_zero) true_residuals(team);
    Dots dots = precondition(
        team,
        [&](Index i) {
          if (starts_at_zero) r[i] = system.inverse_mass[i] > 0 ? b[i] : Vec3r{};
          return r[i];
        },
        r, z);

    // The first direction is the preconditioned residual. The start is the best x so far.
    team.for_each(n, [&](Index i) {
      p[i] = z[i];
      best[i] = x[i];
    });
    double best_rr = dots.rr;
    int idle = 0;

    // The step along p minimises the energy; it fails when rounding has eaten the curvature, or at
    // NaN.
    while (result.iterations < max_iterations && dots.rr > tolerance * tolerance * bb) {
      const double pq =
          multiply<double>(team, p.sub(0, n), [&](Index i) { return dot_double(p[i], q[i]); });
      if (!(pq > 0) || !(dots.rz > 0)) break;
      const double rz = dots.rz;
      const Real alpha = static_cast<Real>(rz / pq);

      // Now and then the residual is computed anew, since the one that is carried along drifts away
      // by rounding. When it stops improving, rounding rules and the iteration ends.
      const bool replace = ++result.iterations % kReplaceEvery == 0;
      dots = replace ? step_anew(team, alpha) : step_along(team, alpha);
      if (replace && dots.rr < best_rr) {
        best_rr = dots.rr;
        idle = 0;
        team.for_each(n, [&](Index i) { best[i] = x[i]; });
      } else if (replace && ++idle == kPatience) {
        break;
      }

      // The next direction is conjugate to the last one.
      const Real beta = static_cast<Real>(dots.rz / rz);
      team.for_each(n, [&](Index i) { p[i] = z[i] + beta * p[i]; });
    }

    // In single precision a very stiff system can run away from the solution, so the best x is
    // returned.
    ResidualSums end = true_residuals(team);
    if (!(end.rr <= best_rr)) {
      team.for_each(n, [&](Index i) { x[i] = best[i]; });
      end = true_residuals(team);
    }
    result.residual = std::sqrt(end.rr / bb);
    result.residual_sum = end.sum;
    return result;
  }
};

/// The bytes that one iteration has to read and write when every number is moved once: the blocks
/// and their places, the contacts, and 15 vectors and a block for each row.
double bytes_per_iteration(const SystemView& system, Index rows) {
  const double blocks = system.column.size(), others = system.lower_column.size();
  return blocks * (9 * sizeof(Real) + sizeof(Index)) + 2 * sizeof(Index) * others +
         static_cast<double>(system.couplings.size()) *
             (sizeof(Coupling) + 4 * sizeof(CouplingCorner) + 2 * sizeof(Vec3r)) +
         static_cast<double>(rows) *
             (15 * sizeof(Vec3r) + sizeof(Mat3r) + sizeof(Real) + 3 * sizeof(Index));
}

/// Factor by which the true residual may exceed the tolerance: the one that the iterations carry
/// along differs from it by rounding.
constexpr double kResidualSlack = 1.5;

}  // namespace

LinearSolution LinearSolver::solve(const SystemView& system, View<const Mat3r> inverse_diagonal,
                                   View<const Vec3r> b, View<Vec3r> padded,
                                   const SolveOptions& options) {
  const Index n = b.size(), couplings = system.couplings.size();
  for (Array<Vec3r>* a : {&r_, &z_, &p_, &q_, &best_}) a->resize(n + kPadding);
  contact_.resize(couplings);
  solution_.resize(1);

  // One kernel makes the whole solve, and its result is read back.
  const auto iterate = [&](const auto& preconditioner, int max_iterations) {
    // The loops of the solve go over the vertices or over the couplings.
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
    LinearSolution solution;
    solution_.download_range(0, {&solution, 1});
    return solution;
  };

  // The multilevel preconditioner comes first where it was chosen.
  const double bytes = bytes_per_iteration(system, n);
  LinearSolution coarse;
  if (options.preconditioner == Preconditioner::multilevel) {
    if (options.change == MatrixChange::all) hierarchy_.fill_matrix(system);
    if (options.change == MatrixChange::some_rows)
      hierarchy_.fill_matrix(system, options.changed_rows);
    hierarchy_.fill_contacts(system);
    coarse = iterate(hierarchy_.view(system, inverse_diagonal), options.max_iterations);
    coarse.bytes = coarse.iterations * (bytes + hierarchy_.bytes());

    // Rounding can hide the masses in the sums of a level; block-Jacobi gets further then.
    if (!(coarse.residual > kResidualSlack * options.tolerance) ||
        coarse.iterations >= options.max_iterations)
      return coarse;
  }

  // Block-Jacobi goes on from the x that it left, with the iterations that are left.
  LinearSolution solution =
      iterate(BlockJacobi{inverse_diagonal}, options.max_iterations - coarse.iterations);
  solution.bytes = coarse.bytes + solution.iterations * bytes;
  solution.iterations += coarse.iterations;
  return solution;
}

}  // namespace icloth::ICLOTH_BUILD
