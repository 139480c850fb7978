// How a kernel is launched and how its blocks get shared memory, in the words of nvcc.
//
// They are macros because g++ must read the same sources: tests/cuda_on_host defines them otherwise
// before this file is read, and then runs the kernels on the host.
#pragma once

#if !defined(ICLOTH_LAUNCH)

/// ICLOTH_LAUNCH(kernel, blocks, threads[, shared bytes[, stream]])(arguments …)
#define ICLOTH_LAUNCH(kernel, ...) kernel<<<__VA_ARGS__>>>

/// Declares `name`, an array of `bytes` bytes that the threads of a block share: raw bytes, because
/// shared variables must not have constructors.
#define ICLOTH_SHARED(name, bytes) __shared__ alignas(16) unsigned char name[bytes]

/// Declares `name`, the bytes that a launch asked for beyond those.
#define ICLOTH_SHARED_OF_LAUNCH(name) extern __shared__ __align__(16) unsigned char name[]

#endif
