// In a program without CUDA all vertices go through the host.
#include "render/cuda_vertices.h"

namespace icloth {

namespace {
constexpr const char* kReason = "built without CUDA";
}

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
