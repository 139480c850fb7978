#include "sim/bodies/contract.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"

namespace icloth {
namespace {

constexpr int kSweeps = 400;              // of Gauss–Seidel, every second one backwards
constexpr double kLeastCotangent = 0.05;  // keeps the weights positive at obtuse corners

/// Neighbours of all vertices in rows, with their weights.
struct Laplacian {
  std::vector<Index> first, neighbour;
  std::vector<double> weight, mass;  ///< mass: a third of the area of the faces of a vertex [m²]
};

Laplacian laplacian_of(const std::vector<Vec3d>& x,
                       const std::vector<std::array<Index, 3>>& faces) {
  Laplacian l;
  l.mass.assign(x.size(), 0);
  l.first.assign(x.size() + 1, 0);
  for (const std::array<Index, 3>& f : faces)
    for (Index v : f) l.first[at(v) + 1] += 2;
  for (std::size_t v = 0; v < x.size(); ++v) l.first[v + 1] += l.first[v];
  l.neighbour.resize(at(l.first.back()));
  l.weight.resize(at(l.first.back()));

  // Each face adds half the cotangent of a corner to both directions of the edge opposite to it.
  std::vector<Index> next(l.first.begin(), l.first.end() - 1);
  for (const std::array<Index, 3>& f : faces)
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = f[c], b = f[(c + 1) % 3], o = f[(c + 2) % 3];
      const Vec3d p = x[at(a)] - x[at(o)], q = x[at(b)] - x[at(o)];
      const double twice_area = norm(cross(p, q));
      l.mass[at(a)] += twice_area / 6;
      const double cotangent = twice_area > 0 ? dot(p, q) / twice_area : 0;
      const double w = 0.5 * std::clamp(cotangent, kLeastCotangent, 1 / kLeastCotangent);
      for (const auto& [from, to] : {std::array{a, b}, std::array{b, a}}) {
        l.neighbour[at(next[at(from)])] = to;
        l.weight[at(next[at(from)]++)] = w;
      }
    }
  return l;
}

}  // namespace

void contract(std::vector<Vec3d>& positions, const std::vector<std::array<Index, 3>>& faces,
              double length) {
  const Laplacian l = laplacian_of(positions, faces);
  const std::vector<Vec3d> start = positions;
  const double t = length * length;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const std::size_t v = sweep % 2 == 0 ? k : positions.size() - 1 - k;
      Vec3d sum = l.mass[v] * start[v];
      double weight = l.mass[v];
      for (Index e = l.first[v]; e < l.first[v + 1]; ++e) {
        sum += t * l.weight[at(e)] * positions[at(l.neighbour[at(e)])];
        weight += t * l.weight[at(e)];
      }
      if (weight > 0) positions[v] = (1 / weight) * sum;
    }
}

}  // namespace icloth
