// Positions and normals as the shaders read them. One text serves the host and a CUDA device, so
// that a picture does not depend on where the vertices were packed.
#pragma once

#include <span>
#include <vector>

#include "kernels/vec.h"
#include "sim/files/mesh.h"

namespace icloth {

/// The faces around each vertex.
struct VertexFaces {
  std::vector<Index> corners;  ///< vertices of the faces (3 F)
  std::vector<Index> first;    ///< of each vertex in `around`, then the length of it (V + 1)
  std::vector<Index> around;   ///< faces, ascending for each vertex (3 F)

  Index vertices() const { return static_cast<Index>(first.size()) - 1; }
};

/// Makes the lists; every entry of `faces` must be less than `vertices`.
VertexFaces vertex_faces(Index vertices, std::span<const Triangle> faces);

/// Writes position and unit normal of one vertex. The normal is the sum of the faces' normals,
/// weighted by area and gathered in the order of the faces, which is fixed and needs no atomics. A
/// vertex whose faces cancel out, or that has none, gets (0, 1, 0). It is built without contraction
/// everywhere, so the bits are the same on every processor.
struct PackVertex {
  const Vec3f* source;   ///< [m] (V)
  const Index* corners;  ///< as in VertexFaces
  const Index* first;
  const Index* around;
  Vec3f* positions;  ///< out [m] (V)
  Vec3f* normals;    ///< out (V)

  ICLOTH_HD void operator()(Index v) const {
    positions[v] = source[v];
    normals[v] = normal(v);
  }

  ICLOTH_HD Vec3f normal(Index v) const {
    Vec3f sum{};
    for (Index k = first[v]; k < first[v + 1]; ++k) {
      const Index* corner = corners + 3 * around[k];
      const Vec3f a = source[corner[0]];
      sum += cross(source[corner[1]] - a, source[corner[2]] - a);
    }
    const Vec3f unit = normalized(sum);
    return norm2(unit) == 0 ? Vec3f{0, 1, 0} : unit;
  }
};

/// Packs all vertices on the host. `positions` [m] and `normals` may be write-only memory (V).
void pack_vertices(const VertexFaces& faces, std::span<const Vec3f> source, Vec3f* positions,
                   Vec3f* normals);

}  // namespace icloth
