#include "render/shared_vertices.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>

namespace icloth {

namespace {

Vec3f face_normal(std::span<const Vec3f> p, const Triangle& t) {
  const Vec3f a = p[static_cast<std::size_t>(t[0])];
  return cross(p[static_cast<std::size_t>(t[1])] - a, p[static_cast<std::size_t>(t[2])] - a);
}

}  // namespace

void vertex_normals(std::span<const Vec3f> positions, std::span<const Triangle> faces,
                    std::vector<Vec3f>& normals) {
  normals.assign(positions.size(), Vec3f{});
  for (const Triangle& t : faces) {
    const Vec3f normal = face_normal(positions, t);
    for (Index v : t) normals[static_cast<std::size_t>(v)] += normal;
  }
  for (Vec3f& n : normals) {
    n = normalized(n);
    if (norm2(n) == 0) n = {0, 1, 0};
  }
}

bool SharedVertices::interop_available(std::string* reason) {
#if defined(ICLOTH_HAS_CUDA)
  if (reason) *reason = "interop is not in this version yet";
#else
  if (reason) *reason = "built without CUDA";
#endif
  return false;
}

SharedVertices::SharedVertices(const World& world) : world_(&world) {
  way_ = interop_available(&reason_) ? Way::interop : Way::host_copy;
  const auto bytes = static_cast<GLsizeiptr>(sizeof(Vec3f)) * world.vertices;
  glCreateBuffers(2, buffers_);
  for (unsigned buffer : buffers_)
    glNamedBufferStorage(buffer, bytes, nullptr, GL_MAP_WRITE_BIT | GL_DYNAMIC_STORAGE_BIT);
}

SharedVertices::~SharedVertices() { glDeleteBuffers(2, buffers_); }

std::string SharedVertices::way_text() const {
  return std::string(way_ == Way::interop ? "CUDA-OpenGL interop" : "host copy") + " (" + reason_ +
         ")";
}

void SharedVertices::upload(std::span<const Vec3f> positions) {
  assert(positions.size() == static_cast<std::size_t>(world_->vertices));
  vertex_normals(positions, world_->face, normals_);
  const std::span<const Vec3f> sources[] = {positions, normals_};
  for (int k = 0; k < 2; ++k) {
    const auto bytes = static_cast<GLsizeiptr>(sources[k].size_bytes());
    // Invalidating lets the driver hand out fresh memory while the last frame is still drawn.
    void* mapped = glMapNamedBufferRange(buffers_[k], 0, bytes,
                                         GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    if (mapped) {
      std::copy(sources[k].begin(), sources[k].end(), static_cast<Vec3f*>(mapped));
      if (glUnmapNamedBuffer(buffers_[k])) continue;
    }
    glNamedBufferSubData(buffers_[k], 0, bytes, sources[k].data());  // not mappable, or lost
  }
}

}  // namespace icloth
