// A made-up system of the implicit step, put together on the host, for the tests of its solver.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "kernels/index.h"
#include "sim/linear/linear_solver.h"

namespace icloth::cpu32 {

struct TestSystem {
  std::vector<Real> inverse_mass;
  std::map<std::pair<Index, Index>, Mat3r> blocks;  ///< upper half
  std::vector<Coupling> coupling_list;
  std::vector<Index> row_first{0}, column;

  BlockMatrix matrix;
  Array<Real> masses;
  Array<Coupling> couplings;
  CouplingCorners coupling_corners;
  Array<Mat3r> inverse_diagonal;
  Array<Vec3r> b, x;

  /// `blocks` as a matrix of so many rows.
  void upload_matrix(Index rows) {
    std::vector<Mat3r> value;
    auto block = blocks.begin();
    for (Index i = 0; i < rows; ++i) {
      for (; block != blocks.end() && block->first.first == i; ++block) {
        column.push_back(block->first.second);
        value.push_back(block->second);
      }
      row_first.push_back(static_cast<Index>(column.size()));
    }
    matrix.set_pattern(row_first, column);
    matrix.value.fill(Mat3r{});
    matrix.value.upload_range(0, value);
  }

  /// The other parts; the preconditioner's blocks are inverted from `blocks` as they are now.
  void upload_rest(Index rows, const std::vector<Vec3r>& rhs) {
    std::vector<Mat3r> inverse;
    for (Index i = 0; i < rows; ++i)
      inverse.push_back(inverse_mass[at(i)] > 0 ? inverse_spd(blocks[{i, i}]) : Mat3r{});
    inverse_diagonal.upload(inverse);
    masses.upload(inverse_mass);
    couplings.upload(coupling_list);
    coupling_corners.build(couplings.view(), rows);
    b.upload(rhs);
    x.resize(rows + kPadding);
    x.fill(Vec3r{});
  }

  SystemView system() {
    return {matrix.view(),
            masses.view(),
            {couplings.view(), coupling_corners.first(), coupling_corners.view()}};
  }

  /// Starts from what x holds.
  LinearSolution solve_from_x(const SolveOptions& options) {
    LinearSolver solver;
    solver.set_up(row_first, column);
    return solver.solve(system(), inverse_diagonal.view(), b.view(), x.view(), options);
  }
};

}  // namespace icloth::cpu32
