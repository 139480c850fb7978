// Helpers of the tests of single stages: a scene in the memory of the stages, without a Solver, and
// the slow obvious list of all pairs. Included after ICLOTH_BUILD and ICLOTH_REAL are defined.
#pragma once

#include <random>
#include <set>
#include <vector>

#include "kernels/index.h"
#include "sim/scene/world.h"
#include "sim/state/state.h"
#include "tests/support/small_scenes.h"

namespace icloth::ICLOTH_BUILD {

struct Stage {
  explicit Stage(Scene s) : scene(std::move(s)), world(make_world(scene)) {
    parameters = scene.parameters;
    mesh.upload(world);
    std::vector<Real> mass, inverse(size(), Real(0));
    for (std::size_t i = 0; i < world.mass.size(); ++i) {
      mass.push_back(static_cast<Real>(world.mass[i]));
      if (world.pinned[i] == 0) inverse[i] = 1 / mass[i];
    }
    state.mass.upload(mass);
    state.inverse_mass.upload(inverse);
    for (const Vec3d& p : world.position) start.push_back(convert<Real>(p));
    state.x0.upload(start);
    set_velocity(std::vector<Vec3r>(size()));
    set_end(start);
  }

  std::size_t size() const { return static_cast<std::size_t>(world.vertices); }
  /// Substep of length `dt`, so late in the simulation that no contact is still growing to its
  /// thickness.
  SubstepContext context(Real dt = Real(0.01)) {
    constexpr double kLate = 1e9;
    return {mesh, parameters, state, report, dt, kLate};
  }

  void set_velocity(const std::vector<Vec3r>& v) { state.v.upload(v); }
  /// Candidate of the step; also x1.
  void set_end(const std::vector<Vec3r>& x1) {
    state.x1.upload(x1);
    state.candidate.upload(std::vector<Vec3r>(x1.begin(), x1.begin() + world.cloth_vertices));
  }

  Scene scene;
  World world;
  Parameters parameters;
  Topology mesh;
  State state;
  StepReport report;
  std::vector<Vec3r> start;  ///< x0
};

/// Vectors with components up to `size` for the vertices of cloths (of all: `obstacles`).
inline std::vector<Vec3r> random_vectors(const Stage& stage, std::mt19937& random, Real size,
                                         bool obstacles) {
  std::uniform_real_distribution<Real> uniform(-size, size);
  std::vector<Vec3r> out(stage.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3r v{uniform(random), uniform(random), uniform(random)};
    if (obstacles || static_cast<Index>(i) < stage.world.cloth_vertices) out[i] = v;
  }
  return out;
}

inline std::vector<Vec3r> sum(std::vector<Vec3r> a, const std::vector<Vec3r>& b, Real scale = 1) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += scale * b[i];
  return a;
}

inline std::vector<Index> corners(const World& world, bool edge_edge, Index a, Index b) {
  if (edge_edge)
    return {world.edge[at(a)][0], world.edge[at(a)][1], world.edge[at(b)][0], world.edge[at(b)][1]};
  const Triangle& f = world.face[at(b)];
  return {a, f[0], f[1], f[2]};
}

/// Calls visit(edge_edge, pair, corners) for every pair that the solver has to know: no vertex
/// shared, at least one element of a cloth.
template <class Visit>
void for_all_pairs(const World& world, const Visit& visit) {
  const auto visit_pair = [&](bool edge_edge, Index a, Index b) {
    const std::vector<Index> v = corners(world, edge_edge, a, b);
    if (std::set<Index>(v.begin(), v.end()).size() == 4) visit(edge_edge, Pair{a, b}, v);
  };
  for (Index v = 0; v < world.vertices; ++v)
    for (Index f = 0; f < world.faces; ++f)
      if (v < world.cloth_vertices || f < world.cloth_faces) visit_pair(false, v, f);
  for (Index a = 0; a < world.cloth_edges; ++a)
    for (Index b = a + 1; b < world.edges; ++b) visit_pair(true, a, b);
}

}  // namespace icloth::ICLOTH_BUILD
