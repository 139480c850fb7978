// The two buffers of OpenGL that hold a mesh's vertices.
#pragma once

#include <span>

#include "render/pack_vertices.h"

namespace icloth {

/// Positions and normals as shader storage: three floats a vertex, tightly packed. Needs a current
/// context, also to destroy.
class VertexBuffers {
 public:
  /// Makes buffers filled with zeros.
  explicit VertexBuffers(Index vertices);
  ~VertexBuffers();
  VertexBuffers(const VertexBuffers&) = delete;
  VertexBuffers& operator=(const VertexBuffers&) = delete;

  unsigned positions() const { return names_[0]; }
  unsigned normals() const { return names_[1]; }
  Index vertices() const { return vertices_; }

  /// Packs the vertices on the host; `positions` [m] are all of them (V).
  void fill_from_host(const VertexFaces& faces, std::span<const Vec3f> positions) const;

  /// Reads the present content of both buffers (V). Waits for all drawing.
  void read_back(std::span<Vec3f> positions, std::span<Vec3f> normals) const;

 private:
  Index vertices_;
  unsigned names_[2] = {0, 0};
};

}  // namespace icloth
