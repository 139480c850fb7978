// The solver's matrix-free product and its answers against a dense solve in double.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "tests/sim/linear/linear_system_support.h"

namespace icloth::cpu32 {
namespace {

/// Random symmetric positive definite system: masses, springs between random pairs of vertices,
/// contacts that also touch vertices beyond the matrix (obstacles), and some prescribed vertices.
struct RandomSystem : TestSystem {
  static constexpr Index kFree = 60, kAll = 70;

  std::mt19937 random;
  std::vector<Vec3r> rhs;

  RandomSystem(unsigned seed, int contact_count) : random(seed) {
    inverse_mass.assign(at(kAll), Real(1));
    for (Index i = 0; i < kAll; ++i)
      if (i >= kFree || i % 11 == 3) inverse_mass[at(i)] = 0;
    for (Index i = 0; i < kFree; ++i) blocks[{i, i}] = Mat3r::identity(1 + uniform(0, 1));
    for (int spring = 0; spring < 200; ++spring) add_spring();
    for (int c = 0; c < contact_count; ++c) add_contact();
    for (Index i = 0; i < kFree; ++i) rhs.push_back(inverse_mass[at(i)] > 0 ? vector() : Vec3r{});
    upload_matrix(kFree);
    upload_rest(kFree, rhs);
  }

  Real uniform(Real low, Real high) {
    return std::uniform_real_distribution<Real>(low, high)(random);
  }
  Index vertex(Index count) { return static_cast<Index>(random() % static_cast<unsigned>(count)); }
  Vec3r vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

  void add_spring() {
    const Index i = vertex(kFree), j = vertex(kFree);
    if (i == j) return;
    const Vec3r along = vector();
    const Mat3r k = Real(3) * outer(along, along);
    blocks[{i, i}] += k;
    blocks[{j, j}] += k;
    blocks[{std::min(i, j), std::max(i, j)}] += Real(-1) * k;
  }

  void add_contact() {
    Coupling c{};
    for (int a = 0; a < 4; ++a) {
      c.s.v[a] = vertex(a < 2 ? kFree : kAll);
      for (int before = 0; before < a; ++before)
        if (c.s.v[before] == c.s.v[a]) return;  // four different vertices
      c.s.w[a] = uniform(-1, 1);
    }
    const Vec3r n = vector();
    const Real d = 10, drag = uniform(0, 1);
    c.h = {{drag + d * n.x * n.x, d * n.x * n.y, d * n.x * n.z, drag + d * n.y * n.y, d * n.y * n.z,
            drag + d * n.z * n.z}};
    coupling_list.push_back(c);
  }

  LinearSolution solve(double tolerance, int iterations,
                       Preconditioner preconditioner = Preconditioner::multilevel) {
    return solve_from_x({preconditioner, tolerance, iterations});
  }

  /// The same system written out, with rows and columns of prescribed vertices replaced by those
  /// of the identity.
  Eigen::MatrixXd dense() const {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * kFree, 3 * kFree);
    for (const auto& [place, block] : blocks)
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
          const double value = static_cast<double>(block(r, c));
          a(3 * place.first + r, 3 * place.second + c) = value;
          a(3 * place.second + c, 3 * place.first + r) = value;
        }
    for (const Coupling& coupling : coupling_list) {
      const Stencil& s = coupling.s;
      const Real* h = coupling.h.m;
      Eigen::Matrix3d block;
      block << h[0], h[1], h[2], h[1], h[3], h[4], h[2], h[4], h[5];
      for (int p = 0; p < 4; ++p)
        for (int q = 0; q < 4; ++q)
          if (s.v[p] < kFree && s.v[q] < kFree)
            a.block<3, 3>(3 * s.v[p], 3 * s.v[q]) +=
                static_cast<double>(s.w[p]) * static_cast<double>(s.w[q]) * block;
    }
    for (Index i = 0; i < kFree; ++i) {
      if (inverse_mass[at(i)] > 0) continue;
      a.middleRows<3>(3 * i).setZero();
      a.middleCols<3>(3 * i).setZero();
      a.block<3, 3>(3 * i, 3 * i).setIdentity();
    }
    return a;
  }

  static Eigen::VectorXd flat(const std::vector<Vec3r>& v) {
    Eigen::VectorXd out(3 * kFree);
    for (Index i = 0; i < kFree; ++i) out.segment<3>(3 * i) << v[at(i)].x, v[at(i)].y, v[at(i)].z;
    return out;
  }
  Eigen::VectorXd solution() const { return flat(x.download()); }
};

TEST(LinearSolver, AgreesWithADenseSolve) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    RandomSystem system(seed, seed == 1 ? 0 : 40);
    const auto preconditioner =
        seed % 2 == 1 ? Preconditioner::multilevel : Preconditioner::block_jacobi;
    const LinearSolution result = system.solve(1e-6, 500, preconditioner);
    const Eigen::VectorXd expected = system.dense().ldlt().solve(RandomSystem::flat(system.rhs));
    EXPECT_LT((system.solution() - expected).norm(), 1e-4 * expected.norm()) << seed;
    EXPECT_GT(result.iterations, 5);
    EXPECT_LT(result.iterations, 500);
    EXPECT_LT(result.residual, 5e-6);
  }
}

TEST(LinearSolver, PrescribedVerticesGetExactlyZero) {
  RandomSystem system(6, 40);
  system.solve(1e-6, 500);
  const std::vector<Vec3r> x = system.x.download();
  int prescribed = 0;
  for (Index i = 0; i < RandomSystem::kFree; ++i) {
    if (system.inverse_mass[at(i)] > 0) continue;
    ++prescribed;
    EXPECT_TRUE(x[at(i)] == Vec3r{});
  }
  EXPECT_EQ(prescribed, 6);
}

TEST(LinearSolver, ReportsTheTrueResidual) {
  for (const int iterations : {1, 3, 8, 60}) {
    RandomSystem system(7, 40);
    const LinearSolution result = system.solve(1e-12, iterations);
    EXPECT_LE(result.iterations, iterations);
    const Eigen::VectorXd b = RandomSystem::flat(system.rhs);
    const double expected = (b - system.dense() * system.solution()).norm() / b.norm();
    EXPECT_NEAR(result.residual, expected, 1e-3 * expected + 1e-6);
  }
}

TEST(LinearSolver, StopsAtTheToleranceAndStartsFromWhatItHolds) {
  RandomSystem system(8, 40);
  const LinearSolution rough = system.solve(1e-2, 500);
  EXPECT_LE(rough.residual, 1.01e-2);
  const LinearSolution fine = system.solve(1e-5, 500);
  EXPECT_LE(fine.residual, 1.1e-5);
  EXPECT_EQ(system.solve(1e-4, 500).iterations, 0);
  RandomSystem fresh(8, 40);
  EXPECT_LT(fine.iterations, fresh.solve(1e-5, 500).iterations);
}

TEST(LinearSolver, NothingToDoLeavesZero) {
  RandomSystem system(9, 40);
  system.b.fill(Vec3r{});
  EXPECT_EQ(system.solve(1e-3, 500).iterations, 0);
  for (const Vec3r& v : system.x.download()) EXPECT_TRUE(v == Vec3r{});
}

}  // namespace
}  // namespace icloth::cpu32
