#include "sim/mechanics/bending.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Energy of a single hinge [J].
struct HingeEnergy {
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

/// Bending energy of a face [J]; edges of more than two faces are left out.
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

}  // namespace

void Bending::lay_out(const World& world, const Topology& mesh, PatternBuilder& builder) {
  builder.begin_elements(sources_);
  if (!mesh.bends) return;
  for (std::size_t h = 0; h < world.hinges.size(); ++h)
    builder.add_element(static_cast<Index>(h), world.hinges[h].vertices);
}

void Bending::prepare(const ForceContext& c) {
  const Topology& mesh = c.mesh;
  if (!mesh.bends) return;

  // Single hinges are a pass of their own, or the last one for the hinges that no plate knows.
  terms_.resize(mesh.hinge_count);
  const HingeBending single{.hinge = mesh.hinge.view(),
                            .fabric = mesh.fabric.view(),
                            .point = c.point,
                            .term = terms_.view(),
                            .extra_damping = static_cast<Real>(c.parameters.material.damping)};
  if (c.parameters.material.bending == BendingModel::hinge)
    for_each("implicit.bending", mesh.hinge_count, single);
  else
    prepare_plates(c, single);
}

void Bending::prepare_plates(const ForceContext& c, const HingeBending& single) {
  const Topology& mesh = c.mesh;
  motions_.resize(mesh.hinge_count);
  plates_.resize(mesh.cloth_faces);
  renewed_plates_.resize(mesh.cloth_faces);
  renewed_hinges_.resize(mesh.hinge_count);

  // Hinges find their angles, faces turn these into torques, and hinges add up the torques of their
  // two faces.
  for_each("implicit.angles", mesh.hinge_count,
           HingeAngles{.hinge = single.hinge,
                       .slots = mesh.hinge_slots.view(),
                       .fabric = single.fabric,
                       .point = c.point,
                       .motion = motions_.view(),
                       .term = terms_.view(),
                       .extra_damping = single.extra_damping});
  for_each("implicit.plates", mesh.cloth_faces,
           PlatePass{.plate = mesh.plate.view(),
                     .hinge = single.hinge,
                     .slots = mesh.hinge_slots.view(),
                     .area = mesh.face_area.view(),
                     .face_fabric = mesh.face_fabric.view(),
                     .fabric = single.fabric,
                     .point = c.point,
                     .motion = motions_.view(),
                     .hinge_term = terms_.view(),
                     .term = plates_.view(),
                     .extra_damping = single.extra_damping,
                     .friction = {c.state.yarns.view()},
                     .renewed = renewed_plates_.view()});
  for_each("implicit.bending", mesh.hinge_count,
           GatherPlates{mesh.hinge_slots.view(), plates_.view(), single, renewed_plates_.view(),
                        renewed_hinges_.view()});
}

void Bending::add_energy(const EnergyContext& c, ForceEnergy& energy) const {
  const Topology& mesh = c.mesh;
  if (!mesh.bends) return;

  // The two models are energies of hinges and of faces, respectively.
  if (c.parameters.material.bending == BendingModel::hinge)
    energy.elastic += reduce("statistics.bending", mesh.hinge_count, 0.0,
                             HingeEnergy{mesh.hinge.view(), mesh.fabric.view(), c.x}, Sum{});
  else
    energy.elastic += reduce("statistics.bending", mesh.cloth_faces, 0.0,
                             PlateEnergy{.plate = mesh.plate.view(),
                                         .hinge = mesh.hinge.view(),
                                         .area = mesh.face_area.view(),
                                         .face_fabric = mesh.face_fabric.view(),
                                         .fabric = mesh.fabric.view(),
                                         .x = c.x},
                             Sum{});
}

}  // namespace icloth::ICLOTH_BUILD
