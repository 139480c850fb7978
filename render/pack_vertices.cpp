#include "render/pack_vertices.h"

#include <cassert>

namespace icloth {

VertexFaces vertex_faces(Index vertices, std::span<const Triangle> faces) {
  VertexFaces list;

  // The corners are listed and counted by vertex; the counts become offsets.
  list.first.assign(static_cast<std::size_t>(vertices) + 1, 0);
  for (const Triangle& t : faces) {
    for (const Index v : t) {
      list.corners.push_back(v);
      ++list.first[static_cast<std::size_t>(v) + 1];
    }
  }
  for (std::size_t v = 0; v < static_cast<std::size_t>(vertices); ++v)
    list.first[v + 1] += list.first[v];

  // The faces of each vertex follow in ascending order.
  list.around.resize(list.corners.size());
  std::vector<Index> next = list.first;
  for (std::size_t k = 0; k < list.corners.size(); ++k) {
    Index& at = next[static_cast<std::size_t>(list.corners[k])];
    list.around[static_cast<std::size_t>(at++)] = static_cast<Index>(k / 3);
  }
  return list;
}

void pack_vertices(const VertexFaces& faces, std::span<const Vec3f> source, Vec3f* positions,
                   Vec3f* normals) {
  assert(source.size() == static_cast<std::size_t>(faces.vertices()));
  const PackVertex pack{.source = source.data(),
                        .corners = faces.corners.data(),
                        .first = faces.first.data(),
                        .around = faces.around.data(),
                        .positions = positions,
                        .normals = normals};
  for (Index v = 0; v < faces.vertices(); ++v) pack(v);
}

}  // namespace icloth
