#include "sim/scene/scene_meshes.h"

#include <string>

namespace icloth {

namespace {

/// Positions of the vertices of a file: those of the vertices that stand for them, or the start.
std::vector<Vec3f> expand(const FileLayout& layout, std::span<const Vec3f> simulated) {
  std::vector<Vec3f> positions;
  positions.reserve(layout.vertex.size());
  for (std::size_t v = 0; v < layout.vertex.size(); ++v)
    positions.push_back(layout.vertex[v] == kNone
                            ? convert<float>(layout.positions[v])
                            : simulated[static_cast<std::size_t>(layout.vertex[v])]);
  return positions;
}

}  // namespace

SceneMeshes named_meshes(const Scene& scene, std::span<const Vec3f> positions,
                         std::span<const FileLayout> layouts) {
  SceneMeshes result;
  std::size_t first = 0;
  const auto take = [&](const TriangleMesh& mesh) {
    const auto part = positions.subspan(first, mesh.positions.size());
    first += part.size();
    return part;
  };
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    const std::span<const Vec3f> simulated = take(cloth.mesh);
    const std::string name = "cloth:" + cloth.name;
    if (layouts.empty() || layouts[c].is_identity()) {
      result.meshes.push_back({name, simulated, cloth.mesh.faces, cloth.mesh.uv});
    } else {
      result.expanded.push_back(expand(layouts[c], simulated));
      result.meshes.push_back({name, result.expanded.back(), layouts[c].faces, cloth.mesh.uv});
    }
  }
  for (const Obstacle& obstacle : scene.obstacles)
    result.meshes.push_back(
        {"obstacle:" + obstacle.name, take(obstacle.mesh), obstacle.mesh.faces});
  return result;
}

SceneFaces scene_faces(const Scene& scene) {
  SceneFaces soup;
  Index first = 0;

  // Vertices are counted through all objects, so faces are shifted by the vertices before them.
  const auto append = [&](const TriangleMesh& mesh, int group) {
    for (const Triangle& t : mesh.faces)
      soup.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    soup.group.resize(soup.faces.size(), group);
    first += static_cast<Index>(mesh.positions.size());
  };
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    append(scene.cloths[c].mesh, static_cast<int>(c));
  for (const Obstacle& obstacle : scene.obstacles) append(obstacle.mesh, -1);
  return soup;
}

}  // namespace icloth
