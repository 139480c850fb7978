// The multilevel preconditioner as the solver applies it.
//
//   z = D⁻¹ r + P V(Pᵀ r)
//
// D: diagonal blocks; P: piecewise constant on groups of neighbouring vertices (aggregates, Notay
// 2010, "An aggregation-based algebraic multigrid method"); V: one V-cycle with one damped
// block-Jacobi sweep down and up on each coarser level. The finest level is only added to, as a
// sweep there would cost a product with the whole matrix, which is what an iteration costs.
//
// Symmetric positive definite by construction: a level's matrix is a sum of terms that couple at
// most 4 nodes each, so A ≤ 4 D, and a sweep damped by kDamping ≤ 1/2 never overshoots.
#pragma once

#include "kernels/block_matrix.h"
#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {

/// Two dot products at once, in double.
struct Dots {
  double rz, rr;
  ICLOTH_HD friend Dots operator+(Dots a, Dots b) { return {a.rz + b.rz, a.rr + b.rr}; }
};

/// The preconditioner z = D⁻¹ r.
struct BlockJacobi {
  View<const Mat3r> inverse_diagonal;  ///< (rows)

  /// Applies the preconditioner. residual(i) sets r[i] and returns it; z is written. Returns r·z
  /// and r·r.
  template <class Team, class Residual>
  ICLOTH_HD Dots operator()(Team& team, const Residual& residual, View<const Vec3r>,
                            View<Vec3r> z) const {
    return team.reduce(
        inverse_diagonal.size(), Dots{0, 0},
        [&](Index i) {
          const Vec3r r = residual(i);
          z[i] = inverse_diagonal[i] * r;
          return Dots{dot_double(r, z[i]), dot_double(r, r)};
        },
        Sum{});
  }
};

/// Blocks of full rows, the diagonal among them; there are no rows at all where `first` is empty.
struct CoarseRows {
  View<const Index> first;   ///< (rows + 1)
  View<const Index> column;  ///< ascending in a row
  View<const Mat3r> value;   ///< readable kPadding blocks beyond the end

  /// Calls f(column, block) for the blocks of a row, and not at all beyond the last row.
  template <class F>
  ICLOTH_HD void of_row(Index i, const F& f) const {
    if (i + 1 >= first.size()) return;
    for (Index k = first[i]; k < first[i + 1]; ++k) f(column[k], value[k]);
  }

  /// Row i times a vector of 3 numbers a row; see multiply_row.
  ICLOTH_HD Vec3r multiplied(Index i, const Real* numbers) const {
    BlockRowSum sum;
    of_row(i, [&](Index j, const Mat3r& block) {
      sum.add(block.m, numbers + 3 * static_cast<std::ptrdiff_t>(j));
    });
    return sum.total();
  }
};

/// The nodes of all levels are in one numbering, the finest level first.
struct Multilevel {
  static constexpr int kMaxLevels = 8;
  static constexpr Real kDamping = Real(0.5);
  static constexpr int kLastSweeps = 3;  ///< on the coarsest level; odd, so that they end in t
  /// Levels of so few nodes are left to one block, which waits for its own threads alone.
  static constexpr Index kSmallLevel = 1024;

  struct Level {
    Index first, count;
  };

  View<const Mat3r> inverse_diagonal;  ///< (vertices)
  View<const Real> inverse_mass;       ///< 0: prescribed (vertices)
  View<const Index> group;             ///< node of each vertex (vertices)
  View<const Index> child_first;       ///< (nodes + 1)
  View<const Index> child;             ///< vertices of a node of the finest level, else nodes
  View<const Index> parent;            ///< of each node but the coarsest level's (nodes)
  MatrixView matrix;                   ///< of all levels: no block between two of them (nodes)
  CoarseRows coupled;                  ///< what contacts add to the finest level
  View<const Mat3r> smoother;          ///< kDamping × inverse diagonal block (nodes)
  View<Vec3r> b, z, t;                 ///< right-hand side, correction, scratch (nodes)
  Level level[kMaxLevels];
  int levels;

  /// Applies the preconditioner; the arguments and the result are those of BlockJacobi.
  template <class Team, class Residual>
  ICLOTH_HD Dots operator()(Team& team, const Residual& residual, View<const Vec3r> r,
                            View<Vec3r> out) const {
    // The V-cycle: residuals are restricted to coarser and coarser levels, then corrections come
    // back. The small levels are the last ones, and one block goes down and up through them.
    team.for_each(out.size(), [&](Index i) { residual(i); });
    const int large = large_levels();
    for (int l = 0; l < large; ++l) go_down(team, l, l == 0 ? r : t);
    if (large < levels) {
      team.in_one_block([&](const auto& block) {
        for (int l = large; l < levels; ++l) go_down(block, l, l == 0 ? r : t);
        for (int l = levels - 2; l >= large; --l) go_up(block, level[l]);
      });
    }
    for (int l = levels - 2; l >= 0; --l)
      if (l < large) go_up(team, level[l]);

    // The finest level adds its block diagonal to the correction of its group. Prescribed vertices
    // take no correction.
    return team.reduce(
        out.size(), Dots{0, 0},
        [&](Index i) {
          Vec3r sum = inverse_diagonal[i] * r[i];
          if (levels > 0 && inverse_mass[i] > 0) sum += t[group[i]];
          out[i] = sum;
          return Dots{dot_double(r[i], sum), dot_double(r[i], r[i])};
        },
        Sum{});
  }

 private:
  /// The levels above the first small one. Each has fewer nodes than the one before.
  ICLOTH_HD int large_levels() const {
    int count = 0;
    while (count < levels && level[count].count > kSmallLevel) ++count;
    return count;
  }

  /// Row i of the level's matrix times v.
  ICLOTH_HD Vec3r multiplied(Index i, View<const Vec3r> v) const {
    const Real* numbers = &v.data()->x;
    return multiply_row(matrix, i, numbers) + coupled.multiplied(i, numbers);
  }

  /// Row i after one sweep of damped block Jacobi.
  ICLOTH_HD Vec3r swept(Index i, View<const Vec3r> from) const {
    return from[i] + smoother[i] * (b[i] - multiplied(i, from));
  }

  /// Leaves in t the residual that the next level has to correct, or on the coarsest level the
  /// correction itself.
  template <class Team>
  ICLOTH_HD void go_down(const Team& team, int l, View<const Vec3r> finer) const {
    const Index first = level[l].first, count = level[l].count;

    // The right-hand side of a node is the sum over its children; the first sweep starts from zero.
    team.for_each(count, [&](Index k) {
      const Index i = first + k;
      Vec3r sum{};
      for (Index c = child_first[i]; c < child_first[i + 1]; ++c) sum += finer[child[c]];
      b[i] = sum;
      z[i] = smoother[i] * sum;
    });

    // A level with a coarser one below it passes on its residual.
    if (l + 1 < levels) {
      team.for_each(count, [&](Index k) {
        const Index i = first + k;
        t[i] = b[i] - multiplied(i, z);
      });
      return;
    }

    // The coarsest level sweeps a few times instead, to and fro between two buffers.
    View<Vec3r> from = z, to = t;
    for (int sweep = 0; sweep < kLastSweeps; ++sweep) {
      team.for_each(count, [&](Index k) { to[first + k] = swept(first + k, from); });
      const View<Vec3r> last = from;
      from = to;
      to = last;
    }
  }

  /// Adds the correction of the coarser level and sweeps once; the result is in t.
  template <class Team>
  ICLOTH_HD void go_up(const Team& team, const Level& at) const {
    const Index first = at.first;
    team.for_each(at.count, [&](Index k) { z[first + k] += t[parent[first + k]]; });
    team.for_each(at.count, [&](Index k) { t[first + k] = swept(first + k, z); });
  }
};

}  // namespace icloth::ICLOTH_BUILD
