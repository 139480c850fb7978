// The functions of the CUDA runtime that share buffers with OpenGL.
//
// clang-format off
#include <glad/gl.h>
#include <cuda_gl_interop.h>
// clang-format on

#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/errors.h"
#include "tests/cuda_on_host/device/memory.h"
#include "tests/cuda_on_host/device/settings.h"
#include "tests/cuda_on_host/device/streams.h"

using cuda_on_host::complain;
using cuda_on_host::device_mutex;
using cuda_on_host::DeviceLock;

/// A buffer of OpenGL that was registered.
struct cuda_on_host::SharedBuffer {
  unsigned buffer = 0;  ///< OpenGL's name of it
  std::size_t bytes = 0;
  void* mapped = nullptr;  ///< device memory; null while it is not mapped
};

cudaError_t cudaGraphicsGLRegisterBuffer(cudaGraphicsResource_t* resource, unsigned buffer,
                                         unsigned flags) {
  const DeviceLock lock(device_mutex());
  if (flags != cudaGraphicsRegisterFlagsWriteDiscard)
    complain("buffers can only be registered to be written");
  GLint64 bytes = 0;
  glGetNamedBufferParameteri64v(buffer, GL_BUFFER_SIZE, &bytes);
  *resource = new cuda_on_host::SharedBuffer{buffer, static_cast<std::size_t>(bytes), nullptr};
  return cudaSuccess;
}

cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource_t resource) {
  const DeviceLock lock(device_mutex());
  if (resource->mapped != nullptr) complain("a buffer is unregistered while it is mapped");
  delete resource;
  return cudaSuccess;
}

cudaError_t cudaGraphicsMapResources(int count, cudaGraphicsResource_t* resources, cudaStream_t) {
  const DeviceLock lock(device_mutex());
  for (int k = 0; k < count; ++k) {
    cuda_on_host::SharedBuffer& shared = *resources[k];
    if (shared.mapped != nullptr) complain("a buffer is mapped twice");
    shared.mapped = cuda_on_host::allocate_device(shared.bytes);
    if (shared.mapped == nullptr) return cuda_on_host::fail(cudaErrorMemoryAllocation);
  }
  return cudaSuccess;
}

/// OpenGL sees what the stream wrote, which is therefore waited for.
cudaError_t cudaGraphicsUnmapResources(int count, cudaGraphicsResource_t* resources,
                                       cudaStream_t stream) {
  const DeviceLock lock(device_mutex());
  cuda_on_host::wait_for(cuda_on_host::stream_or_default(stream));
  for (int k = 0; k < count; ++k) {
    cuda_on_host::SharedBuffer& shared = *resources[k];
    if (shared.mapped == nullptr) complain("a buffer is unmapped that was not mapped");
    {
      const cuda_on_host::DeviceAccess access;
      glNamedBufferSubData(shared.buffer, 0, static_cast<GLsizeiptr>(shared.bytes), shared.mapped);
    }
    cuda_on_host::free_device(shared.mapped);
    shared.mapped = nullptr;
  }
  return cudaSuccess;
}

cudaError_t cudaGraphicsResourceGetMappedPointer(void** pointer, std::size_t* bytes,
                                                 cudaGraphicsResource_t resource) {
  if (resource->mapped == nullptr) complain("the address of a buffer that is not mapped");
  *pointer = resource->mapped;
  *bytes = resource->bytes;
  return cudaSuccess;
}

/// The emulated device draws wherever OpenGL does.
cudaError_t cudaGLGetDevices(unsigned* count, int* devices, unsigned most, cudaGLDeviceList) {
  *count = most > 0 ? 1 : 0;
  if (most > 0) devices[0] = 0;
  return cudaSuccess;
}
