#include "sim/mechanics/energy.h"

#include <cstring>

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct VertexEnergy {
  double kinetic, potential, speed2;
};
struct CombineVertices {
  ICLOTH_HD VertexEnergy operator()(VertexEnergy a, VertexEnergy b) const {
    return {a.kinetic + b.kinetic, a.potential + b.potential, Max{}(a.speed2, b.speed2)};
  }
};

struct MotionEnergy {
  View<const Vec3r> x, v;
  View<const Real> mass;
  Vec3d gravity;

  ICLOTH_HD VertexEnergy operator()(Index i) const {
    const double m = static_cast<double>(mass[i]);
    const double v2 = norm2(convert<double>(v[i]));
    return {0.5 * m * v2, -m * dot(gravity, convert<double>(x[i])), v2};
  }
};

struct Speed2 {
  View<const Vec3r> v;
  ICLOTH_HD double operator()(Index i) const { return norm2(convert<double>(v[i])); }
};

/// Finaliser of MurmurHash3 (Appleby, public domain): spreads every input bit over the word.
ICLOTH_HD std::uint64_t mix(std::uint64_t h) {
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33;
  h *= 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

ICLOTH_HD std::uint64_t bits_of(Real value) {
  if constexpr (sizeof(Real) == 8) {
    std::uint64_t u;
    memcpy(&u, &value, sizeof u);
    return u;
  } else {
    std::uint32_t u;
    memcpy(&u, &value, sizeof u);
    return u;
  }
}

/// Position-dependent hash of one vertex; the sum over vertices needs no order.
struct HashVertex {
  View<const Vec3r> x, v;
  ICLOTH_HD std::uint64_t operator()(Index i) const {
    std::uint64_t h = mix(static_cast<std::uint64_t>(i) + 1);
    const Real values[6] = {x[i].x, x[i].y, x[i].z, v[i].x, v[i].y, v[i].z};
    for (const Real value : values) h = mix(h ^ bits_of(value)) + h;
    return h;
  }
};

struct CountInfinite {
  View<const Vec3r> x;
  ICLOTH_HD Index operator()(Index i) const {
    const Real sum = (x[i].x - x[i].x) + (x[i].y - x[i].y) + (x[i].z - x[i].z);
    return sum == 0 ? 0 : 1;  // ∞ − ∞ and NaN are not zero
  }
};

}  // namespace

StateStatistics statistics_of(const Forces& forces, const EnergyContext& shape,
                              View<const Real> mass, View<const Vec3r> v) {
  const ForceEnergy energy = forces.energy(shape);

  const GravityParameters& g = shape.parameters.gravity;
  const VertexEnergy motion =
      reduce("statistics.motion", shape.mesh.cloth_vertices, VertexEnergy{0, 0, 0},
             MotionEnergy{shape.x, v, mass, Vec3d{g.x, g.y, g.z}}, CombineVertices{});
  return {.kinetic = motion.kinetic,
          .elastic = energy.elastic,
          .gravity = motion.potential,
          .outer = energy.outer,
          .strain = energy.strain,
          .speed = std::sqrt(motion.speed2)};
}

double report_state(const Forces& forces, const Topology& mesh, const State& state,
                    const Parameters& parameters, StateReport& report) {
  const StateStatistics statistics =
      statistics_of(forces, {mesh, parameters, state.x1.view()}, state.mass.view(), state.v.view());
  report.kinetic_energy = statistics.kinetic;
  report.elastic_energy = statistics.elastic;
  report.gravity_energy = statistics.gravity;
  report.max_strain = statistics.strain;
  report.max_speed = statistics.speed;
  return statistics.energy();
}

void report_extremes(const Topology& mesh, const State& state, StateReport& report) {
  report.max_strain = largest_strain(mesh, state.x1.view());
  report.max_speed = std::sqrt(
      reduce("statistics.motion", mesh.cloth_vertices, 0.0, Speed2{state.v.view()}, Max{}));
}

std::uint64_t hash_state(const State& state) {
  return reduce("statistics.hash", state.x1.size(), std::uint64_t{0},
                HashVertex{state.x1.view(), state.v.view()}, Sum{});
}

bool all_finite(const State& state) {
  return reduce("statistics.finite", state.x1.size(), Index{0}, CountInfinite{state.x1.view()},
                Sum{}) == 0;
}

}  // namespace icloth::ICLOTH_BUILD
