#include "sim/scene/scene_meshes.h"

#include <string>

namespace icloth {

std::vector<NamedMesh> named_meshes(const Scene& scene, std::span<const Vec3f> positions) {
  std::vector<NamedMesh> meshes;
  std::size_t first = 0;
  const auto append = [&](const std::string& name, const TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    meshes.push_back({name, positions.subspan(first, count), mesh.faces});
    first += count;
  };
  for (const Cloth& cloth : scene.cloths) append("cloth:" + cloth.name, cloth.mesh);
  for (const Obstacle& obstacle : scene.obstacles)
    append("obstacle:" + obstacle.name, obstacle.mesh);
  return meshes;
}

}  // namespace icloth
