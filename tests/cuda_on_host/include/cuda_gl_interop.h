// Stands in for CUDA's header about OpenGL. Include it behind the OpenGL loader.
//
// A buffer that is mapped is device memory of its own, poisoned as mapping with
// WriteDiscard loses the content; unmapping copies it into the buffer. So kernels of the program
// fill buffers of any OpenGL, in software too.
#pragma once

#include "cuda_runtime.h"

namespace cuda_on_host {
struct SharedBuffer;
}
using cudaGraphicsResource_t = ::cuda_on_host::SharedBuffer*;
enum { cudaGraphicsRegisterFlagsWriteDiscard = 2 };
enum cudaGLDeviceList { cudaGLDeviceListAll = 1 };
cudaError_t cudaGraphicsGLRegisterBuffer(cudaGraphicsResource_t* resource, unsigned buffer,
                                         unsigned flags);
cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource_t resource);
cudaError_t cudaGraphicsMapResources(int count, cudaGraphicsResource_t* resources,
                                     cudaStream_t stream);
cudaError_t cudaGraphicsUnmapResources(int count, cudaGraphicsResource_t* resources,
                                       cudaStream_t stream);
cudaError_t cudaGraphicsResourceGetMappedPointer(void** pointer, std::size_t* bytes,
                                                 cudaGraphicsResource_t resource);
cudaError_t cudaGLGetDevices(unsigned* count, int* devices, unsigned most, cudaGLDeviceList list);
