// The fabrics of a scene as the kernels see them.
#pragma once

#include "sim/scene/parameters.h"
#include "sim/scene/scene.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// Writes mesh.fabric, mesh.bends, mesh.has_yarn_friction and mesh.stiffness_table: the materials
/// of the cloths with the scales and choices of the parameters.
void upload_fabrics(Topology& mesh, const Scene& scene, const Parameters& parameters);

/// Writes mesh.plate and mesh.hinge_slots, once.
void upload_plates(Topology& mesh, const World& world);

}  // namespace icloth::ICLOTH_BUILD
