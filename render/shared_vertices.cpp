#include "render/shared_vertices.h"

#include <glad/gl.h>

#include <cassert>

namespace icloth {

SharedVertices::SharedVertices(const World& world, VertexOptions options)
    : options_(std::move(options)),
      faces_(vertex_faces(world.vertices, world.face)),
      buffers_(world.vertices),
      reason_(options_.on_device ? "nothing drawn yet" : "asked for") {}

std::string SharedVertices::path_text() const {
  return std::string(path() == Path::interop ? "CUDA-OpenGL interop" : "host copy") + " (" +
         reason_ + ")";
}

void SharedVertices::update(std::span<const Vec3f> positions, const DevicePositions* on_device) {
  assert(positions.size() == static_cast<std::size_t>(buffers_.vertices()));
  if (!write_on_device(on_device)) buffers_.fill_from_host(faces_, positions);
}

/// Lets the writer fill the buffers, where there is one. A writer that fails is never tried again,
/// as a driver that stumbled once would make pictures stutter.
bool SharedVertices::write_on_device(const DevicePositions* positions) {
  if (!options_.on_device) return false;

  // A buffer that CUDA holds cannot be mapped for the host, so the writer is given up.
  if (!positions) {
    writer_.reset();
    reason_ = "the solver runs on the CPU";
    return false;
  }

  // The first frame with positions on a device tries to make a writer.
  if (!writer_) {
    MadeWriter made = options_.make_writer(faces_, buffers_, positions->device);
    writer_ = std::move(made.writer);
    if (!writer_) {
      give_up(made.reason);
      return false;
    }
    reason_ = writer_->place();
  }

  const std::string failure = writer_->write(*positions);
  if (!failure.empty()) give_up(failure);
  return failure.empty();
}

void SharedVertices::give_up(const std::string& reason) {
  writer_.reset();
  options_.on_device = false;
  reason_ = reason;

  // The error is reported already, so the checks after drawing must not find it again.
  while (glGetError() != GL_NO_ERROR) {
  }
}

}  // namespace icloth
