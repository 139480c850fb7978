// Positions and normals of all vertices on the GPU, by one of two upload paths.
#pragma once

#include <span>
#include <string>

#include "render/cuda_vertices.h"
#include "sim/scene/world.h"

namespace icloth {

struct VertexOptions {
  bool on_device = true;  ///< false: always through the host
  MakeVertexWriter make_writer = make_cuda_writer;
};

/// Buffers of positions and normals for drawing. Positions that the solver leaves on a CUDA device
/// are packed into the buffers there (CUDA-OpenGL interop) and cross no bus; otherwise the host
/// packs and copies them. Both give the same bits. A probe with the first such frame finds out
/// which path works, and when interop fails, then or later, the host copies from then on. Needs a
/// current context, also to destroy.
class SharedVertices {
 public:
  enum class Path { host_copy, interop };

  explicit SharedVertices(const World& world, VertexOptions options = {});

  /// Fills the buffers with the positions of all vertices [m] (V) and the normals computed from
  /// them. `on_device` are the same positions on the solver's device, or null where the solver has
  /// none.
  void update(std::span<const Vec3f> positions, const DevicePositions* on_device);

  /// The path of the last update.
  Path path() const { return writer_ ? Path::interop : Path::host_copy; }
  /// The path with its reason: "host copy (the solver runs on the CPU)".
  std::string path_text() const;

  const VertexBuffers& buffers() const { return buffers_; }

 private:
  bool write_on_device(const DevicePositions* positions);
  void give_up(const std::string& reason);

  VertexOptions options_;
  VertexFaces faces_;
  VertexBuffers buffers_;
  std::unique_ptr<VertexWriter> writer_;  ///< after the buffers: it lets go of them first
  std::string reason_;
};

}  // namespace icloth
