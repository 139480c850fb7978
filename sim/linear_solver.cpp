#include "sim/linear_solver.h"

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

struct ContactProducts {
  SystemView system;
  View<const Vec3r> p;
  View<Vec3r> product;

  ICLOTH_HD void operator()(Index c) const {
    const Stencil& s = system.contacts[c].s;
    Vec3r sum{};
    for (int a = 0; a < 4; ++a)
      if (s.v[a] < p.size()) sum += s.w[a] * p[s.v[a]];
    product[c] = multiply(system.terms[c], sum);
  }
};

/// One row of the product; returns its share of p·Ap.
struct MultiplyRow {
  SystemView system;
  View<const Vec3r> p, contact;
  const Real* numbers;  ///< of p
  View<Vec3r> y;

  ICLOTH_HD double operator()(Index i) const {
    if (!(system.inverse_mass[i] > 0)) {
      y[i] = Vec3r{};
      return 0;
    }
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
    Vec3r sum{row0[0] + row0[1] + row0[2] + columns[0], row1[0] + row1[1] + row1[2] + columns[1],
              row2[0] + row2[1] + row2[2] + columns[2]};
    for (Index k = system.contact_first[i]; k < system.contact_first[i + 1]; ++k) {
      const Index entry = system.contact_entries[k];
      sum += system.contacts[entry / 4].s.w[entry % 4] * contact[entry / 4];
    }
    y[i] = sum;
    return dot_double(p[i], sum);
  }
};

/// r = b − q, z = M⁻¹ r.
struct StartResidual {
  View<const Vec3r> b, q;
  View<const Mat3r> inverse_diagonal;
  View<const Real> inverse_mass;
  View<Vec3r> r, z;

  ICLOTH_HD Dots operator()(Index i) const {
    r[i] = inverse_mass[i] > 0 ? b[i] - q[i] : Vec3r{};
    z[i] = inverse_diagonal[i] * r[i];
    return {dot_double(r[i], z[i]), dot_double(r[i], r[i])};
  }
};

struct Norm2 {
  View<const Vec3r> b;
  ICLOTH_HD double operator()(Index i) const { return dot_double(b[i], b[i]); }
};

/// x += α p, r −= α q, z = M⁻¹ r.
struct Advance {
  Real alpha;
  View<const Vec3r> p, q;
  View<const Mat3r> inverse_diagonal;
  View<Vec3r> x, r, z;

  ICLOTH_HD Dots operator()(Index i) const {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
    z[i] = inverse_diagonal[i] * r[i];
    return {dot_double(r[i], z[i]), dot_double(r[i], r[i])};
  }
};

struct NewDirection {
  Real beta;
  View<const Vec3r> z;
  View<Vec3r> p;
  ICLOTH_HD void operator()(Index i) const { p[i] = z[i] + beta * p[i]; }
};

struct Spoil {
  View<Vec3r> x;
  ICLOTH_HD void operator()(Index i) const { x[i].x = static_cast<Real>(NAN); }
};

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
  const Index n = b.size();
  const View<Vec3r> x = padded.sub(0, n);
  for (Array<Vec3r>* a : {&r_, &z_, &p_, &q_}) a->resize(n + kPadding);
  contact_.resize(system.contacts.size());
  const auto multiply = [&](View<const Vec3r> p) {
    for_each("implicit.contacts", contact_.size(), ContactProducts{system, p, contact_.view()});
    return reduce("implicit.multiply", n, 0.0,
                  MultiplyRow{system, p, contact_.view(), &p.data()->x, q_.view()}, Sum{});
  };
  const auto residual = [&] {
    return reduce(
        "implicit.residual", n, Dots{0, 0},
        StartResidual{b, q_.view(), inverse_diagonal, system.inverse_mass, r_.view(), z_.view()},
        Sum{});
  };

  const double bb = reduce("implicit.residual", n, 0.0, Norm2{b}, Sum{});
  LinearSolution solution;
  if (bb == 0) return solution;
  multiply(x);
  Dots dots = residual();
  p_.copy_from(z_);
  constexpr int kReplaceEvery = 50;  // iterations between true residuals
  while (solution.iterations < max_iterations && dots.rr > tolerance * tolerance * bb) {
    const double pq = multiply(p_.view().sub(0, n));
    if (!(pq > 0) || !(dots.rz > 0)) break;  // rounding has eaten the curvature, or NaN
    const double rz = dots.rz;
    dots = reduce("implicit.advance", n, Dots{0, 0},
                  Advance{static_cast<Real>(rz / pq), p_.view(), q_.view(), inverse_diagonal, x,
                          r_.view(), z_.view()},
                  Sum{});
    if (++solution.iterations % kReplaceEvery == 0) {
      multiply(x);
      dots = residual();
    }
    for_each("implicit.direction", n,
             NewDirection{static_cast<Real>(dots.rz / rz), z_.view(), p_.view()});
  }
  multiply(x);
  solution.residual = std::sqrt(residual().rr / bb);
  // No numbers in, no numbers out: an x that merely stayed zero would pass for a solution.
  if (!std::isfinite(solution.residual)) for_each("implicit.spoil", n, Spoil{x});
  return solution;
}

}  // namespace icloth::ICLOTH_BUILD
