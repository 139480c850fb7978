// The meshes of a scene at given positions, for files and pictures.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh_io.h"
#include "sim/files/weld.h"
#include "sim/scene/scene.h"

namespace icloth {

/// The objects of a scene as their files have them. Views into the scene, into the positions that
/// were given, and into itself.
struct SceneMeshes {
  std::vector<NamedMesh> meshes;             ///< cloths first
  std::vector<std::vector<Vec3f>> expanded;  ///< vertices of files that share a simulated one
};

/// `positions` are those of all simulated vertices, `layouts` those of the cloths; empty: the
/// meshes of the scene are as in their files.
SceneMeshes named_meshes(const Scene& scene, std::span<const Vec3f> positions,
                         std::span<const FileLayout> layouts = {});

/// Faces of all objects as one soup, for find_intersections.
struct SceneFaces {
  std::vector<Triangle> faces;  ///< cloths first; vertices counted through all objects (F)
  std::vector<int> group;       ///< number of the cloth, -1 for obstacles (F)
};
SceneFaces scene_faces(const Scene& scene);

}  // namespace icloth
