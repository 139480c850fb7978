#include "sim/mechanics/membrane.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct FaceEnergy {
  double energy, strain;
};

ICLOTH_HD double strain_of(const Sym2& green) {
  return static_cast<double>(std::sqrt(std::fmax(largest_stretch2(green), Real(0))) - 1);
}

struct FaceStrain {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const Vec3r> x;

  ICLOTH_HD double operator()(Index i) const {
    const Int3 f = face[i];
    const Vec3r xs[3] = {x[f.v[0]], x[f.v[1]], x[f.v[2]]};
    return strain_of(green_strain(face_frame(xs, inverse[i].m)));
  }
};

/// How much more a face is stretched in one shape than in another one.
struct FaceStretch {
  FaceStrain from, to;
  View<const Int3> face;
  ICLOTH_HD double operator()(Index i) const {
    const Int3 f = face[i];
    bool moved = false;
    for (int a = 0; a < 3; ++a) moved = moved || !(norm2(to.x[f.v[a]] - from.x[f.v[a]]) == 0);
    return moved ? to(i) - from(i) : 0;
  }
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
    return {static_cast<double>(area[i] * density), strain_of(g)};
  }
};

}  // namespace

double largest_strain(const Topology& mesh, View<const Vec3r> x) {
  return reduce("statistics.strain", mesh.cloth_faces, 0.0,
                FaceStrain{mesh.face.view(), mesh.face_inverse.view(), x}, Max{});
}

double largest_stretch(const Topology& mesh, View<const Vec3r> from, View<const Vec3r> to) {
  const View<const Int3> face = mesh.face.view();
  const View<const Topology::Inverse> inverse = mesh.face_inverse.view();
  return reduce("impact_zones.stretch", mesh.cloth_faces, 0.0,
                FaceStretch{{face, inverse, from}, {face, inverse, to}, face}, Max{});
}

void Membrane::add_energy(const EnergyContext& c, ForceEnergy& energy) const {
  const Topology& mesh = c.mesh;
  const FaceEnergy faces = reduce("statistics.membrane", mesh.cloth_faces, FaceEnergy{0, 0},
                                  MembraneEnergy{.face = mesh.face.view(),
                                                 .inverse = mesh.face_inverse.view(),
                                                 .area = mesh.face_area.view(),
                                                 .face_fabric = mesh.face_fabric.view(),
                                                 .fabric = mesh.fabric.view(),
                                                 .x = c.x},
                                  CombineFaces{});
  energy.elastic += faces.energy;
  energy.strain = Max{}(energy.strain, faces.strain);
}

}  // namespace icloth::ICLOTH_BUILD
