// In a program without CUDA, or without the headers of interop, all vertices go through the host.
#include "render/cuda_vertices.h"

namespace icloth {

namespace {
#if defined(ICLOTH_HAS_CUDA)
constexpr const char* kReason = "built without OpenGL's headers (GL/gl.h), which interop needs";
#else
constexpr const char* kReason = "built without CUDA";
#endif
}  // namespace

bool gl_runs_on_cuda(int, std::string& reason) {
  reason = kReason;
  return false;
}

bool interop_works(int, std::string& reason) {
  reason = kReason;
  return false;
}

MadeWriter make_cuda_writer(const VertexFaces&, const VertexBuffers&, int) {
  return {nullptr, kReason};
}

}  // namespace icloth
