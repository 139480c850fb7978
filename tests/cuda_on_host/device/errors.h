// Errors that the emulated runtime answers with, as a device would.
#pragma once

#include "cuda_runtime.h"

namespace cuda_on_host {

/// Remembers the error for cudaGetLastError, and returns it.
cudaError_t fail(cudaError_t error);

}  // namespace cuda_on_host
