#include "render/vertex_buffers.h"

#include <glad/gl.h>

#include <cassert>
#include <vector>

namespace icloth {

namespace {

/// Maps a buffer. Invalidating it lets the driver take fresh memory while the last frame is still
/// drawn. Returns null when the driver refuses.
Vec3f* map_for_writing(unsigned buffer, GLsizeiptr bytes) {
  return static_cast<Vec3f*>(
      glMapNamedBufferRange(buffer, 0, bytes, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
}

}  // namespace

VertexBuffers::VertexBuffers(Index vertices) : vertices_(vertices) {
  glCreateBuffers(2, names_);
  for (const unsigned name : names_) {
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(sizeof(Vec3f)) * vertices, nullptr,
                         GL_MAP_WRITE_BIT | GL_DYNAMIC_STORAGE_BIT);
    glClearNamedBufferData(name, GL_R32F, GL_RED, GL_FLOAT, nullptr);
  }
}

VertexBuffers::~VertexBuffers() { glDeleteBuffers(2, names_); }

void VertexBuffers::fill_from_host(const VertexFaces& faces,
                                   std::span<const Vec3f> positions) const {
  assert(positions.size() == static_cast<std::size_t>(vertices_));
  const auto bytes = static_cast<GLsizeiptr>(positions.size_bytes());

  // The vertices are packed straight into mapped memory, where the driver allows it and keeps it.
  Vec3f* const mapped[] = {map_for_writing(names_[0], bytes), map_for_writing(names_[1], bytes)};
  bool kept = mapped[0] && mapped[1];
  if (kept) pack_vertices(faces, positions, mapped[0], mapped[1]);
  for (int k = 0; k < 2; ++k)
    if (mapped[k] && !glUnmapNamedBuffer(names_[k])) kept = false;
  if (kept) return;

  // Otherwise they are packed into lists and copied.
  std::vector<Vec3f> lists[] = {std::vector<Vec3f>(positions.size()),
                                std::vector<Vec3f>(positions.size())};
  pack_vertices(faces, positions, lists[0].data(), lists[1].data());
  for (int k = 0; k < 2; ++k) glNamedBufferSubData(names_[k], 0, bytes, lists[k].data());
}

void VertexBuffers::read_back(std::span<Vec3f> positions, std::span<Vec3f> normals) const {
  const std::span<Vec3f> lists[] = {positions, normals};
  for (int k = 0; k < 2; ++k) {
    glGetNamedBufferSubData(names_[k], 0, static_cast<GLsizeiptr>(lists[k].size_bytes()),
                            lists[k].data());
  }
}

}  // namespace icloth
