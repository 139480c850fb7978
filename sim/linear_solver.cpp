#include "sim/linear_solver.h"

#include <algorithm>
#include <cmath>

#include "kernels/lanes.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Two dot products at once, in double.
struct Dots {
  double rz, rr;
  ICLOTH_HD friend Dots operator+(Dots a, Dots b) { return {a.rz + b.rz, a.rr + b.rr}; }
};

ICLOTH_HD double dot_double(Vec3r a, Vec3r b) {
  return dot(convert<double>(a), convert<double>(b));
}

/// One row of the product without the contacts' share; every stored block serves two rows.
ICLOTH_HD Vec3r multiply_row(const SystemView& system, Index i, const Real* numbers) {
  // Three numbers a row are read as four: one vector multiplication. The fourth is not used; the
  // arrays are one element longer than their content, so that it can be read.
  Lanes row0{}, row1{}, row2{}, columns{};
  for (Index k = system.row_first[i]; k < system.row_first[i + 1]; ++k) {
    const Real* m = system.entries + 9 * static_cast<std::ptrdiff_t>(k);
    const Lanes v = load_lanes(numbers + 3 * static_cast<std::ptrdiff_t>(system.column[k]));
    row0 += load_lanes(m) * v;
    row1 += load_lanes(m + 3) * v;
    row2 += load_lanes(m + 6) * v;
  }
  for (Index k = system.lower_first[i]; k < system.lower_first[i + 1]; ++k) {
    const Real* m = system.entries + 9 * static_cast<std::ptrdiff_t>(system.lower_block[k]);
    const Real* v = numbers + 3 * static_cast<std::ptrdiff_t>(system.lower_column[k]);
    columns += load_lanes(m) * v[0];
    columns += load_lanes(m + 3) * v[1];
    columns += load_lanes(m + 6) * v[2];
  }
  return {row0[0] + row0[1] + row0[2] + columns[0], row1[0] + row1[1] + row1[2] + columns[1],
          row2[0] + row2[1] + row2[2] + columns[2]};
}

/// The whole solve, for one team: every thread goes through the same iterations and has the same
/// scalars, so that nothing has to be read back in between.
struct ConjugateGradients {
  SystemView system;
  View<const Mat3r> inverse_diagonal;
  View<const Vec3r> b;
  View<Vec3r> x, r, z, p, q;
  View<Vec3r> contact;  ///< H Σ w p of each contact
  double tolerance;
  int max_iterations;
  View<LinearSolution> solution;  ///< (1)

  /// q = A v; returns v·Av.
  template <class Team>
  ICLOTH_HD double multiply(Team& team, View<const Vec3r> v) const {
    if (contact.size() > 0) {
      team.for_each(contact.size(), [&](Index c) {
        const Stencil& s = system.contacts[c].s;
        Vec3r sum{};
        for (int a = 0; a < 4; ++a)
          if (s.v[a] < b.size()) sum += s.w[a] * v[s.v[a]];
        contact[c] = icloth::ICLOTH_BUILD::multiply(system.terms[c], sum);
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
          for (Index k = system.contact_first[i]; k < system.contact_first[i + 1]; ++k) {
            const Index entry = system.contact_entries[k];
            sum += system.contacts[entry / 4].s.w[entry % 4] * contact[entry / 4];
          }
          q[i] = sum;
          return dot_double(v[i], sum);
        },
        Sum{});
  }

  ICLOTH_HD Dots precondition(Index i) const {
    z[i] = inverse_diagonal[i] * r[i];
    return {dot_double(r[i], z[i]), dot_double(r[i], r[i])};
  }

  /// r = b − A x, z = M⁻¹ r.
  template <class Team>
  ICLOTH_HD Dots true_residual(Team& team) const {
    multiply(team, x);
    return team.reduce(
        b.size(), Dots{0, 0},
        [&](Index i) {
          r[i] = system.inverse_mass[i] > 0 ? b[i] - q[i] : Vec3r{};
          return precondition(i);
        },
        Sum{});
  }

  template <class Team>
  ICLOTH_HD void operator()(Team& team) const {
    const Index n = b.size();
    const double bb = team.reduce(
        n, 0.0, [&](Index i) { return dot_double(b[i], b[i]); }, Sum{});
    LinearSolution result;
    if (bb != 0) result = iterate(team, bb);
    // No numbers in, no numbers out: an x that merely stayed zero would pass for a solution.
    if (!(result.residual - result.residual == 0))
      team.for_each(n, [&](Index i) { x[i].x = static_cast<Real>(NAN); });
    team.single([&] { solution[0] = result; });
  }

  template <class Team>
  ICLOTH_HD LinearSolution iterate(Team& team, double bb) const {
    constexpr int kReplaceEvery = 50;  // iterations between true residuals
    const Index n = b.size();
    LinearSolution result;
    Dots dots = true_residual(team);
    team.for_each(n, [&](Index i) { p[i] = z[i]; });
    while (result.iterations < max_iterations && dots.rr > tolerance * tolerance * bb) {
      const double pq = multiply(team, p.sub(0, n));
      if (!(pq > 0) || !(dots.rz > 0)) break;  // rounding has eaten the curvature, or NaN
      const double rz = dots.rz;
      const Real alpha = static_cast<Real>(rz / pq);
      dots = team.reduce(
          n, Dots{0, 0},
          [&](Index i) {
            x[i] += alpha * p[i];
            r[i] -= alpha * q[i];
            return precondition(i);
          },
          Sum{});
      if (++result.iterations % kReplaceEvery == 0) dots = true_residual(team);
      const Real beta = static_cast<Real>(dots.rz / rz);
      team.for_each(n, [&](Index i) { p[i] = z[i] + beta * p[i]; });
    }
    result.residual = std::sqrt(true_residual(team).rr / bb);
    return result;
  }
};

/// What one iteration has to read and write when every number is moved once: the blocks and their
/// places, the contacts, and 15 vectors and a block for each row.
double bytes_per_iteration(const SystemView& system, Index rows) {
  const double blocks = system.column.size(), others = system.lower_column.size();
  return blocks * (9 * sizeof(Real) + sizeof(Index)) + 2 * sizeof(Index) * others +
         static_cast<double>(system.contacts.size()) *
             (sizeof(Contact) + sizeof(ContactTerm) + 2 * sizeof(Vec3r)) +
         static_cast<double>(rows) *
             (15 * sizeof(Vec3r) + sizeof(Mat3r) + sizeof(Real) + 3 * sizeof(Index));
}

}  // namespace

void BlockMatrix::set_pattern(const std::vector<Index>& first, const std::vector<Index>& columns) {
  const std::size_t rows = first.size() - 1;
  std::vector<Index> lower(rows + 1, 0);
  const auto for_lower = [&](const auto& visit) {
    for (std::size_t i = 0; i < rows; ++i)
      for (Index k = first[i]; k < first[i + 1]; ++k) {
        const Index j = columns[static_cast<std::size_t>(k)];
        if (j != static_cast<Index>(i)) visit(static_cast<Index>(i), j, k);
      }
  };
  for_lower([&](Index, Index j, Index) { ++lower[static_cast<std::size_t>(j) + 1]; });
  for (std::size_t i = 0; i < rows; ++i) lower[i + 1] += lower[i];
  std::vector<Index> place(lower.begin(), lower.end() - 1);
  std::vector<Index> lower_columns(columns.size() - rows), blocks(columns.size() - rows);
  for_lower([&](Index i, Index j, Index k) {
    const auto slot = static_cast<std::size_t>(place[static_cast<std::size_t>(j)]++);
    lower_columns[slot] = i;
    blocks[slot] = k;
  });
  row_first.upload(first);
  column.upload(columns);
  lower_first.upload(lower);
  lower_column.upload(lower_columns);
  lower_block.upload(blocks);
  value.resize(static_cast<Index>(columns.size()) + kPadding);
}

LinearSolution LinearSolver::solve(const SystemView& system, View<const Mat3r> inverse_diagonal,
                                   View<const Vec3r> b, View<Vec3r> padded, double tolerance,
                                   int max_iterations) {
  const Index n = b.size(), contacts = system.contacts.size();
  for (Array<Vec3r>* a : {&r_, &z_, &p_, &q_}) a->resize(n + kPadding);
  contact_.resize(contacts);
  solution_.resize(1);
  with_device_team("implicit.solve", std::max(n, contacts),
                   ConjugateGradients{system, inverse_diagonal, b, padded.sub(0, n), r_.view(),
                                      z_.view(), p_.view(), q_.view(), contact_.view(), tolerance,
                                      max_iterations, solution_.view()});
  LinearSolution solution;
  solution_.download_range(0, {&solution, 1});
  solution.bytes = solution.iterations * bytes_per_iteration(system, n);
  return solution;
}

}  // namespace icloth::ICLOTH_BUILD
