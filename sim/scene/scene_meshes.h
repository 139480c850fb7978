// The meshes of a scene at given positions, for files and pictures.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh_io.h"
#include "sim/scene/scene.h"

namespace icloth {

/// The objects of a scene, cloths first, at positions of all its vertices. Views into both.
std::vector<NamedMesh> named_meshes(const Scene& scene, std::span<const Vec3f> positions);

}  // namespace icloth
