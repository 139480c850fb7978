#include "sim/mechanics/energy.h"

#include <cstring>

#include "kernels/bending.h"
#include "kernels/parallel/parallel.h"
#include "kernels/strain_limit.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct FaceEnergy {
  double energy, strain;
};
struct CombineFaces {
  ICLOTH_HD FaceEnergy operator()(FaceEnergy a, FaceEnergy b) const {
    return {a.energy + b.energy, Max{}(a.strain, b.strain)};
  }
};

struct MembraneEnergy {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  View<const Vec3r> x;

  ICLOTH_HD FaceEnergy operator()(Index i) const {
    const Int3 f = face[i];
    const Vec3r xs[3] = {x[f.v[0]], x[f.v[1]], x[f.v[2]]};
    const Sym2 g = green_strain(face_frame(xs, inverse[i].m));
    const Fabric& cloth = fabric[face_fabric[i]];
    const Real density = membrane_energy(stiffness_at(cloth, g), g) + limit_energy(cloth, g);
    return {static_cast<double>(area[i] * density),
            static_cast<double>(std::sqrt(std::fmax(largest_stretch2(g), Real(0))) - 1)};
  }
};

struct BendingEnergy {
  View<const HingeRest> hinge;
  View<const Fabric> fabric;
  View<const Vec3r> x;

  ICLOTH_HD double operator()(Index i) const {
    const HingeRest& h = hinge[i];
    const Real theta = hinge_angle_of(h, x).theta;
    const Real k = hinge_stiffness(fabric[h.fabric0], fabric[h.fabric1], h, theta);
    return 0.5 * static_cast<double>(k * (theta - h.angle) * (theta - h.angle));
  }
};

/// Of the faces; an edge of more than two faces is left out.
struct PlateEnergy {
  View<const PlateRest> plate;
  View<const HingeRest> hinge;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  View<const Vec3r> x;

  ICLOTH_HD double operator()(Index i) const {
    const PlateRest& p = plate[i];
    Real angle[3];
    plate_angles(p, hinge, x, angle);
    const Sym2 c = plate_curvature(p, angle);
    return static_cast<double>(area[i] * plate_energy(plate_moduli(fabric[face_fabric[i]], c), c));
  }
};

double bending_energy(const Topology& mesh, const Parameters& parameters, View<const Vec3r> x) {
  if (!mesh.bends) return 0;
  if (parameters.material.bending == BendingModel::plate)
    return reduce("statistics.bending", mesh.cloth_faces, 0.0,
                  PlateEnergy{mesh.plate.view(), mesh.hinge.view(), mesh.face_area.view(),
                              mesh.face_fabric.view(), mesh.fabric.view(), x},
                  Sum{});
  return reduce("statistics.bending", mesh.hinge_count, 0.0,
                BendingEnergy{mesh.hinge.view(), mesh.fabric.view(), x}, Sum{});
}

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

StateFigures figures_of(const Topology& mesh, const Parameters& parameters, View<const Real> mass,
                        View<const Vec3r> x, View<const Vec3r> v) {
  const FaceEnergy faces =
      reduce("statistics.membrane", mesh.cloth_faces, FaceEnergy{0, 0},
             MembraneEnergy{mesh.face.view(), mesh.face_inverse.view(), mesh.face_area.view(),
                            mesh.face_fabric.view(), mesh.fabric.view(), x},
             CombineFaces{});
  const double bending = bending_energy(mesh, parameters, x);
  const Vec3d gravity{parameters.gravity.x, parameters.gravity.y, parameters.gravity.z};
  const VertexEnergy motion =
      reduce("statistics.motion", mesh.cloth_vertices, VertexEnergy{0, 0, 0},
             MotionEnergy{x, v, mass, gravity}, CombineVertices{});
  return {motion.kinetic, faces.energy + bending, motion.potential, faces.strain,
          std::sqrt(motion.speed2)};
}

double report_state(const Topology& mesh, const State& state, const Parameters& parameters,
                    StepReport& report) {
  const StateFigures figures =
      figures_of(mesh, parameters, state.mass.view(), state.x1.view(), state.v.view());
  report.kinetic_energy = figures.kinetic;
  report.elastic_energy = figures.elastic;
  report.gravity_energy = figures.gravity;
  report.max_strain = figures.strain;
  report.max_speed = figures.speed;
  return figures.energy();
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
