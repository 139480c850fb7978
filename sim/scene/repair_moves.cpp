#include "sim/scene/repair_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/index.h"

namespace icloth {
namespace {

constexpr int kMostSweeps = 20;          ///< over all constraints
constexpr int kInnerSweeps = 40;         ///< over those that act, after each of them
constexpr int kStall = 3;                ///< sweeps without a smaller correction
constexpr double kOverRelaxation = 1.3;  ///< fewest sweeps in trials; below 2 it converges
constexpr int kMostRounds = 40;          ///< of evening out the moves
constexpr int kPatience = 4;             ///< of them that do not help

/// The motion of least Σ |move|² / ease that opens every gap by what it misses. Hildreth's method:
/// one constraint after the other, with multipliers that never pull.
class SmallestMoves {
 public:
  SmallestMoves(std::span<const GapConstraint> constraints, std::span<const double> missing)
      : constraints_(constraints),
        missing_(missing),
        multiplier_(constraints.size(), 0),
        response_(constraints.size(), 0) {}

  /// Goes on from the multipliers of the call before. Returns the largest correction of the last
  /// sweep [m]: above `tolerance` the constraints cannot all hold, or not yet.
  double solve(std::span<const double> ease, double tolerance, std::int64_t& work) {
    prepare(ease);

    // Most constraints never act. Between two sweeps over all of them come some over those that do.
    double worst = 2 * tolerance, least = std::numeric_limits<double>::infinity();
    int waited = 0;
    for (int sweep = 0; sweep < kMostSweeps && worst > tolerance && work > 0; ++sweep) {
      if (waited > kStall) break;
      worst = 0;
      acting_.clear();
      for (std::size_t i = 0; i < constraints_.size(); ++i) {
        worst = std::max(worst, correct(i, ease));
        if (multiplier_[i] > 0) acting_.push_back(i);
      }
      double still = worst;
      int inner = 0;
      for (; inner < kInnerSweeps && still > tolerance; ++inner) {
        still = 0;
        for (const std::size_t i : acting_) still = std::max(still, correct(i, ease));
      }
      waited = worst < 0.95 * least ? 0 : waited + 1;
      least = std::min(least, worst);
      work -= static_cast<std::int64_t>(constraints_.size()) +
              inner * static_cast<std::int64_t>(acting_.size());
    }
    return worst;
  }

  const std::vector<Vec3d>& moves() const { return move_; }

 private:
  /// The motion of the present multipliers, and how much a unit of each opens its gap.
  void prepare(std::span<const double> ease) {
    move_.assign(ease.size(), {});
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      const GapConstraint& c = constraints_[i];
      response_[i] = 0;
      for (std::size_t k = 0; k < 4; ++k) response_[i] += c.w[k] * c.w[k] * ease[at(c.v[k])];
      if (multiplier_[i] > 0) push(i, multiplier_[i], ease);
    }
  }

  double correct(std::size_t i, std::span<const double> ease) {
    const GapConstraint& c = constraints_[i];
    double opened = 0;
    for (std::size_t k = 0; k < 4; ++k) opened += c.w[k] * dot(c.n, move_[at(c.v[k])]);
    const double step =
        std::max(kOverRelaxation * (missing_[i] - opened) / response_[i], -multiplier_[i]);
    if (step == 0) return 0;
    multiplier_[i] += step;
    push(i, step, ease);
    return std::fabs(step) * response_[i];
  }

  void push(std::size_t i, double step, std::span<const double> ease) {
    const GapConstraint& c = constraints_[i];
    for (std::size_t k = 0; k < 4; ++k)
      move_[at(c.v[k])] += (step * c.w[k] * ease[at(c.v[k])]) * c.n;
  }

  std::span<const GapConstraint> constraints_;
  std::span<const double> missing_;
  std::vector<double> multiplier_, response_;
  std::vector<Vec3d> move_;
  std::vector<std::size_t> acting_;
};

double largest(std::span<const Vec3d> moves) {
  double most = 0;
  for (const Vec3d& m : moves) most = std::max(most, norm(m));
  return most;
}

}  // namespace

void move_vertices(RepairMesh& mesh, std::span<const GapConstraint> all, double limit,
                   double tolerance, std::int64_t& work) {
  // No vertex has to move further than the most that a constraint lacks at the start.
  std::vector<double> all_missing;
  double most = 0;
  for (const GapConstraint& c : all) {
    Vec3d gap;
    for (std::size_t k = 0; k < 4; ++k) gap += c.w[k] * mesh.base[at(c.v[k])];
    all_missing.push_back(c.target - dot(c.n, gap));
    most = std::max(most, all_missing.back());
  }

  // Wider gaps than such moves can close are left out.
  std::vector<GapConstraint> constraints;
  std::vector<double> missing;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all_missing[i] > -2.5 * most) {
      constraints.push_back(all[i]);
      missing.push_back(all_missing[i]);
    }

  // Vertices that would move further are made heavier, so that their neighbours move more, as long
  // as the constraints hold with that and it helps.
  std::vector<double> ease(mesh.free.begin(), mesh.free.end());
  SmallestMoves solver(constraints, missing);
  double residual = solver.solve(ease, tolerance, work);
  std::vector<Vec3d> move = solver.moves();
  int waited = 0;
  for (int round = 0; round < kMostRounds && waited < kPatience; ++round) {
    bool far = false;
    for (std::size_t v = 0; v < move.size(); ++v) {
      const double length = norm(solver.moves()[v]);
      if (!(length > 1.001 * most)) continue;
      ease[v] *= std::pow(most / length, 2);
      far = true;
    }
    if (!far) break;
    const double next = solver.solve(ease, tolerance, work);
    const bool better =
        next <= std::max(residual, tolerance) && largest(solver.moves()) < 0.999 * largest(move);
    waited = better ? 0 : waited + 1;
    if (!better) continue;
    residual = next;
    move = solver.moves();
  }

  // The positions are rounded to single precision, as the solver will read them.
  for (std::size_t v = 0; v < mesh.x.size(); ++v) {
    const double length = norm(move[v]);
    if (length > limit) move[v] = (limit / length) * move[v];
    mesh.x[v] = convert<double>(convert<float>(mesh.base[v] + move[v]));
  }
}

}  // namespace icloth
