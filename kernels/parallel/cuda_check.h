// Every CUDA call goes through here, so that none fails silently.
#pragma once

#include <cuda_runtime.h>

#include <stdexcept>
#include <string>

#include "kernels/parallel/platform.h"

namespace icloth::ICLOTH_BUILD::detail {

/// Throws std::runtime_error that names the caller, the place and the error.
inline void cuda_check(const char* name, cudaError_t error, const char* file, int line) {
  if (error == cudaSuccess) return;
  static_cast<void>(cudaGetLastError());  // a later check must not report this one again
  throw std::runtime_error(std::string("CUDA: ") + name + ": " + cudaGetErrorString(error) + " (" +
                           cudaGetErrorName(error) + ", " + file + ":" + std::to_string(line) +
                           ")");
}

}  // namespace icloth::ICLOTH_BUILD::detail

/// A macro only because it has to know file and line of the call.
#define ICLOTH_CUDA_CHECK(name, call) \
  ::icloth::ICLOTH_BUILD::detail::cuda_check(name, call, __FILE__, __LINE__)
