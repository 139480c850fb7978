// The interface by which positions that are already on a device get into OpenGL's buffers.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kernels/device_positions.h"
#include "render/pack_vertices.h"
#include "render/vertex_buffers.h"

namespace icloth {

/// Fills two buffers of the current OpenGL context from device memory. Its maker and it need that
/// context to be current, also to destroy.
class VertexWriter {
 public:
  virtual ~VertexWriter() = default;

  /// Writes position and normal of every vertex. Returns in one line why it could not; an empty
  /// text means that all is written before OpenGL reads it. Errors of the device are never thrown.
  virtual std::string write(const DevicePositions& positions) = 0;

  /// The place where it works, for example "CUDA device 0".
  virtual std::string place() const = 0;
};

/// The writer, or the reason in one line why there is none.
struct MadeWriter {
  std::unique_ptr<VertexWriter> writer;
  std::string reason;
};

/// Makes a writer that fills the buffers of a mesh with these faces from positions on `device`.
/// The buffers outlive it.
using MakeVertexWriter =
    std::function<MadeWriter(const VertexFaces&, const VertexBuffers&, int device)>;

}  // namespace icloth
