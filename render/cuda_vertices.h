// The only header of CUDA-OpenGL interop. It is implemented by render/cuda/cuda_vertices.cu, or by
// render/cuda_vertices_none.cpp in a program without CUDA.
#pragma once

#include <string>

#include "render/vertex_writer.h"

namespace icloth {

/// True when the current OpenGL context draws on the CUDA device with this ordinal, or may do so
/// and CUDA cannot say. Otherwise `reason` says in one line where it draws. CUDA is asked, because
/// its ordinals are no numbers of OpenGL or EGL.
bool gl_runs_on_cuda(int device, std::string& reason);

/// True when a small mesh that CUDA packs into buffers of the current context reads back through
/// OpenGL with the very bits that the host computes; otherwise `reason` says in one line why not.
/// Errors that it meets are cleared, in CUDA and in OpenGL.
bool interop_works(int device, std::string& reason);

/// Makes the probe above, then a writer for the buffers, which it registers with CUDA until
/// destroyed.
MadeWriter make_cuda_writer(const VertexFaces& faces, const VertexBuffers& buffers, int device);

}  // namespace icloth
