#include "sim/mechanics/fabrics.h"

#include <algorithm>

#include "kernels/parallel/parallel.h"
#include "sim/mechanics/plates.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Beyond the strain limit this many times the stiffest of the fabric's own values comes in.
constexpr double kLimitFactor = 20;

Real real(double value) { return static_cast<Real>(value); }

void add_strain_limit(Fabric& f, const Material& material, const Parameters& p) {
  const double limit =
      p.material.strain_limit > 0 ? p.material.strain_limit : material.strain_limit;
  if (!(limit > 0)) return;
  double stiffest = 0;
  for (const auto& row : material.stretching) stiffest = std::max({stiffest, row[0], row[2]});
  f.limit_strain = real(limit * (1 + limit / 2));
  f.limit_stiffness = real(kLimitFactor * 2 * p.material.stretch_scale * stiffest);
}

Fabric make_fabric(const Material& material, const Parameters& p) {
  // The scales of the parameters multiply the measured tables.
  Fabric f{};
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t c = 0; c < 4; ++c)
      f.stretching[row][c] = real(p.material.stretch_scale * material.stretching[row][c]);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t c = 0; c < 5; ++c)
      f.bending[row][c] = real(p.material.bend_scale * material.bending[row][c]);

  f.damping = real(material.damping);
  f.measured = material.law == Material::Law::measured;
  f.bending_spacing = real(material.bending_spacing);
  f.bending_poisson = real(material.bending_poisson);

  // The scales of stretching and bending apply to the friction against the same deformation.
  f.bending_friction =
      real(p.material.yarn_friction * p.material.bend_scale * material.bending_friction);
  f.shear_friction =
      real(p.material.yarn_friction * p.material.stretch_scale * material.shear_friction);
  f.most_stiffness = tensile_bound(f);
  add_strain_limit(f, material, p);
  return f;
}

bool bends(const Fabric& f) {
  for (const auto& row : f.bending)
    for (const Real k : row)
      if (k > 0) return true;
  return f.bending_friction > 0;
}

bool has_yarn_friction(const Fabric& f) { return f.bending_friction > 0 || f.shear_friction > 0; }

}  // namespace

void upload_fabrics(Topology& mesh, const Scene& scene, const Parameters& parameters) {
  // Each cloth has a fabric of its own.
  std::vector<Fabric> fabrics;
  for (const Cloth& cloth : scene.cloths)
    fabrics.push_back(make_fabric(cloth.material, parameters));

  // On request the stiffness of measured fabrics is read from a table.
  const bool tables = parameters.material.evaluation == MaterialEvaluation::table;
  mesh.stiffness_table.resize(tables ? StiffnessTable::kSize * static_cast<Index>(fabrics.size())
                                     : 0);
  for (std::size_t i = 0; tables && i < fabrics.size(); ++i) {
    if (!fabrics[i].measured) continue;
    Stiffness* const first =
        mesh.stiffness_table.view().data() + static_cast<Index>(i) * StiffnessTable::kSize;
    for_each("step.stiffness_table", StiffnessTable::kSize,
             FillStiffnessTable{fabrics[i], View<Stiffness>(first, StiffnessTable::kSize)});
    fabrics[i].table = first;
  }

  mesh.fabric.upload(fabrics);
  mesh.bends = std::ranges::any_of(fabrics, bends);
  mesh.has_yarn_friction = std::ranges::any_of(fabrics, has_yarn_friction);
}

void upload_plates(Topology& mesh, const World& world) {
  if (mesh.plate.size() == mesh.cloth_faces) return;

  // Each hinge gets its slots in its two faces; edges of more than two faces have none.
  std::vector<PlateRest> plates;
  std::vector<HingeSlots> slots(world.hinges.size(), HingeSlots{{-1, -1}});
  for (const FacePlate& plate : make_plates(world)) {
    PlateRest rest{};
    for (std::size_t i = 0; i < 9; ++i) rest.w[i] = real(plate.w[i]);
    for (std::size_t a = 0; a < 3; ++a) {
      const Index hinge = rest.hinge[a] = plate.hinge[a];
      if (hinge < 0) continue;
      HingeSlots& slot = slots[static_cast<std::size_t>(hinge)];
      slot.slot[slot.slot[0] < 0 ? 0 : 1] = static_cast<Index>(3 * plates.size() + a);
    }
    plates.push_back(rest);
  }

  mesh.plate.upload(plates);
  mesh.hinge_slots.upload(slots);
}

}  // namespace icloth::ICLOTH_BUILD
