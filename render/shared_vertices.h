// Positions and normals of all vertices on the GPU, by one of two ways.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/world.h"

namespace icloth {

/// Buffers of positions and normals for drawing. With interop the CUDA solver packs both into the
/// mapped buffers and nothing crosses the bus; otherwise they are copied from the host. Which way
/// runs is found out once by a probe, never guessed. Needs a current context, also to destroy.
class SharedVertices {
 public:
  enum class Way { host_copy, interop };

  explicit SharedVertices(const World& world);
  ~SharedVertices();
  SharedVertices(const SharedVertices&) = delete;
  SharedVertices& operator=(const SharedVertices&) = delete;

  /// True when CUDA can write into buffers of the current context; `reason` says in one line why
  /// not.
  static bool interop_available(std::string* reason = nullptr);

  /// Copies positions of all vertices [m] (V) and the normals computed from them.
  void upload(std::span<const Vec3f> positions);

  Way way() const { return way_; }
  /// E.g. "host copy (built without CUDA)".
  std::string way_text() const;

  /// Shader storage buffers: floats, three a vertex, tightly packed.
  unsigned positions_buffer() const { return buffers_[0]; }
  unsigned normals_buffer() const { return buffers_[1]; }

 private:
  const World* world_;
  Way way_ = Way::host_copy;
  std::string reason_;
  unsigned buffers_[2] = {0, 0};
  std::vector<Vec3f> normals_;
};

/// Unit normals of the vertices: the sum of the faces' normals weighted by area. A vertex whose
/// faces cancel out gets (0, 1, 0).
void vertex_normals(std::span<const Vec3f> positions, std::span<const Triangle> faces,
                    std::vector<Vec3f>& normals);

}  // namespace icloth
