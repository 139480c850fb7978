// CUDA-OpenGL interop: the only file that sees both. It is compiled without contraction, as the
// host's code is, so that the packed bits are the host's.
//
// clang-format off
#include <glad/gl.h>  // before the next one, which would take the system's GL/gl.h
#include <cuda_gl_interop.h>
// clang-format on

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "kernels/device_positions_cuda.h"
#include "kernels/parallel/launch.h"
#include "render/cuda_vertices.h"
#include "render/gl_context.h"

namespace icloth {
namespace {

constexpr int kThreads = 256;

__global__ void pack_kernel(Index count, const PackVertex pack) {
  const auto v = static_cast<std::int64_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (v < count) pack(static_cast<Index>(v));
}

/// An empty text when the call worked. Otherwise the error is cleared, so that no later check meets
/// it.
std::string failure_of(const char* what, cudaError_t error) {
  if (error == cudaSuccess) return {};
  static_cast<void>(cudaGetLastError());
  return std::string(what) + " failed: " + cudaGetErrorString(error);
}

/// A constant list in device memory.
class DeviceList {
 public:
  DeviceList() = default;
  ~DeviceList() { static_cast<void>(cudaFree(memory_)); }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;

  cudaError_t upload(const void* host, std::size_t bytes) {
    const cudaError_t error = cudaMalloc(&memory_, std::max<std::size_t>(bytes, 1));
    if (error != cudaSuccess) return error;
    return cudaMemcpy(memory_, host, bytes, cudaMemcpyHostToDevice);
  }
  cudaError_t upload(const std::vector<Index>& host) {
    return upload(host.data(), host.size() * sizeof(Index));
  }
  template <class T>
  const T* data() const {
    return static_cast<const T*>(memory_);
  }

 private:
  void* memory_ = nullptr;
};

/// Registers the buffers once and maps both together for every frame. It works on a stream of its
/// own that does not wait for the solver's later work, only for the positions that it is given.
class CudaWriter final : public VertexWriter {
 public:
  ~CudaWriter() override;

  std::string set_up(const VertexFaces& faces, const VertexBuffers& buffers, int device);
  std::string write(const DevicePositions& from) override;
  std::string place() const override { return "CUDA device " + std::to_string(device_); }

 private:
  std::string upload(const VertexFaces& faces);
  std::string register_buffers(const VertexBuffers& buffers);
  std::string pack(const DevicePositions& from);
  std::string mapped_pointer(int buffer, Vec3f*& out) const;

  int device_ = 0;
  Index vertices_ = 0;
  DeviceList corners_, first_, around_;
  cudaStream_t stream_ = nullptr;
  cudaGraphicsResource_t resources_[2] = {nullptr, nullptr};  ///< positions, normals
};

CudaWriter::~CudaWriter() {
  static_cast<void>(cudaSetDevice(device_));
  if (stream_ != nullptr) static_cast<void>(cudaStreamSynchronize(stream_));
  for (cudaGraphicsResource_t resource : resources_)
    if (resource != nullptr) static_cast<void>(cudaGraphicsUnregisterResource(resource));
  if (stream_ != nullptr) static_cast<void>(cudaStreamDestroy(stream_));
  static_cast<void>(cudaGetLastError());
}

std::string CudaWriter::set_up(const VertexFaces& faces, const VertexBuffers& buffers, int device) {
  device_ = device;
  vertices_ = faces.vertices();
  std::string failure = failure_of("selecting the device", cudaSetDevice(device));
  if (failure.empty()) {
    failure =
        failure_of("making a stream", cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  }
  if (failure.empty()) failure = upload(faces);
  if (failure.empty()) failure = register_buffers(buffers);
  return failure;
}

std::string CudaWriter::upload(const VertexFaces& faces) {
  for (const auto& [list, host] :
       {std::pair{&corners_, &faces.corners}, std::pair{&first_, &faces.first},
        std::pair{&around_, &faces.around}}) {
    const std::string failure = failure_of("copying the faces", list->upload(*host));
    if (!failure.empty()) return failure;
  }
  return {};
}

std::string CudaWriter::register_buffers(const VertexBuffers& buffers) {
  const unsigned names[] = {buffers.positions(), buffers.normals()};
  for (int k = 0; k < 2; ++k) {
    const std::string failure =
        failure_of("registering a buffer",
                   cudaGraphicsGLRegisterBuffer(&resources_[k], names[k],
                                                cudaGraphicsRegisterFlagsWriteDiscard));
    if (failure.empty()) continue;
    resources_[k] = nullptr;
    return failure;
  }
  return {};
}

std::string CudaWriter::write(const DevicePositions& from) {
  // Positions that could not be copied, or that belong elsewhere, are refused in one line.
  if (!from.failure.empty()) return from.failure;
  if (from.device != device_) {
    return "the solver runs on CUDA device " + std::to_string(from.device) +
           ", OpenGL on CUDA device " + std::to_string(device_);
  }
  if (from.count != vertices_) {
    return "the solver handed out " + std::to_string(from.count) + " vertices, expected " +
           std::to_string(vertices_);
  }
  std::string failure = failure_of("selecting the device", cudaSetDevice(device_));
  if (!failure.empty()) return failure;

  // Work in the stream from here on starts when OpenGL has finished its earlier commands.
  failure = failure_of("mapping the buffers", cudaGraphicsMapResources(2, resources_, stream_));
  if (!failure.empty()) return failure;
  failure = pack(from);

  // OpenGL goes on when the work in the stream is done.
  const std::string unmapping =
      failure_of("unmapping the buffers", cudaGraphicsUnmapResources(2, resources_, stream_));
  return failure.empty() ? unmapping : failure;
}

/// Writes every byte of both buffers, since mapping loses their content.
std::string CudaWriter::pack(const DevicePositions& from) {
  PackVertex pack{.source = from.data,
                  .corners = corners_.data<Index>(),
                  .first = first_.data<Index>(),
                  .around = around_.data<Index>(),
                  .positions = nullptr,
                  .normals = nullptr};
  std::string failure = mapped_pointer(0, pack.positions);
  if (failure.empty()) failure = mapped_pointer(1, pack.normals);
  if (!failure.empty()) return failure;

  // The stream waits until the solver has written the positions.
  failure = failure_of("waiting for the positions",
                       cudaStreamWaitEvent(stream_, static_cast<cudaEvent_t>(from.written), 0));
  if (!failure.empty()) return failure;
  const unsigned blocks = (static_cast<unsigned>(vertices_) + kThreads - 1) / kThreads;
  if (blocks > 0) ICLOTH_LAUNCH(pack_kernel, blocks, kThreads, 0, stream_)(vertices_, pack);
  failure = failure_of("packing the vertices", cudaGetLastError());
  if (!failure.empty()) return failure;

  // The solver may write again when the kernel has read.
  failure = failure_of("recording the end of reading",
                       cudaEventRecord(static_cast<cudaEvent_t>(from.read), stream_));

  // Without the event nobody could wait for the kernel, so it is waited for here.
  if (!failure.empty()) static_cast<void>(cudaStreamSynchronize(stream_));
  return failure;
}

/// The address of a mapped buffer, which may change from one mapping to the next.
std::string CudaWriter::mapped_pointer(int buffer, Vec3f*& out) const {
  void* pointer = nullptr;
  std::size_t bytes = 0;
  const std::string failure =
      failure_of("asking for the address of a buffer",
                 cudaGraphicsResourceGetMappedPointer(&pointer, &bytes, resources_[buffer]));
  if (!failure.empty()) return failure;
  if (bytes < static_cast<std::size_t>(vertices_) * sizeof(Vec3f))
    return "mapping the buffers failed: only " + std::to_string(bytes) + " bytes are there";
  out = static_cast<Vec3f*>(pointer);
  return {};
}

/// Makes a writer without asking whether it works.
MadeWriter make_unprobed(const VertexFaces& faces, const VertexBuffers& buffers, int device) {
  auto writer = std::make_unique<CudaWriter>();
  const std::string failure = writer->set_up(faces, buffers, device);
  if (!failure.empty()) return {nullptr, failure};
  return {std::move(writer), {}};
}

// ---- the probe ----------------------------------------------------------------------------------

/// A crooked pyramid, small and with no number that rounds well.
constexpr std::array<Vec3f, 5> kProbePoints{{{0.1f, -0.2f, 0.3f},
                                             {1.7f, 0.13f, -0.4f},
                                             {1.1f, 0.07f, 1.9f},
                                             {-0.6f, 0.31f, 1.3f},
                                             {0.3f, 2.3f, 0.7f}}};
constexpr std::array<Triangle, 5> kProbeFaces{
    {{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}, {0, 1, 2}}};
using ProbeList = std::array<Vec3f, kProbePoints.size()>;

bool same_bits(const ProbeList& a, const ProbeList& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Packs the pyramid by CUDA into buffers of OpenGL and reads them back; an empty text when the
/// bits are the host's.
std::string probe(int device) {
  std::string failure = failure_of("selecting the device", cudaSetDevice(device));
  if (!failure.empty()) return failure;

  // The host's result is the expected one.
  const VertexFaces faces =
      vertex_faces(static_cast<Index>(kProbePoints.size()), std::span(kProbeFaces));
  ProbeList positions, normals;
  pack_vertices(faces, kProbePoints, positions.data(), normals.data());

  // The device gets the same positions, as the solver would leave them.
  DeviceList source;
  failure = failure_of("copying to the device", source.upload(&kProbePoints, sizeof kProbePoints));
  if (!failure.empty()) return failure;

  // OpenGL's buffers are written by CUDA; they must outlive the writer.
  CudaPositions copied;
  copied.copy(source.data<Vec3f>(), static_cast<Index>(kProbePoints.size()));
  const VertexBuffers buffers(static_cast<Index>(kProbePoints.size()));
  const MadeWriter made = make_unprobed(faces, buffers, device);
  if (!made.writer) return made.reason;
  failure = made.writer->write(copied);
  if (!failure.empty()) return failure;

  // OpenGL reads them back, bit for bit.
  ProbeList read_positions{}, read_normals{};
  buffers.read_back(read_positions, read_normals);
  if (same_bits(read_positions, positions) && same_bits(read_normals, normals)) return {};
  return "the bytes that CUDA writes are not those that OpenGL reads";
}

/// "llvmpipe" for "llvmpipe (LLVM 15.0.6, 256 bits)"; names of cards stay whole.
std::string gl_name() {
  const std::string name = gl_device_name();
  return gl_is_software() ? name.substr(0, name.find(" (")) : name;
}

bool gl_is_nvidia() {
  const GLubyte* vendor = glGetString(GL_VENDOR);
  return vendor && std::strstr(reinterpret_cast<const char*>(vendor), "NVIDIA");
}

/// The reason in words when OpenGL draws on something else than the CUDA device.
std::string elsewhere(int device, int count) {
  std::string text = "OpenGL runs on " + gl_name() + ", not on ";
  text += count == 1 ? "the CUDA device" : "CUDA device " + std::to_string(device);
  // With two graphics cards in one machine the user can move OpenGL to the other one; the program
  // never does.
  if (!gl_is_software() && !gl_is_nvidia()) {
    text +=
        "; on a laptop with two cards start it with __NV_PRIME_RENDER_OFFLOAD=1 "
        "__GLX_VENDOR_LIBRARY_NAME=nvidia";
  }
  return text;
}

void clear_gl_errors() {
  while (glGetError() != GL_NO_ERROR) {
  }
}

}  // namespace

bool gl_runs_on_cuda(int device, std::string& reason) {
  // Without a CUDA device there is nothing to share with.
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) {
    static_cast<void>(cudaGetLastError());
    reason = "no CUDA device";
    return false;
  }

  // OpenGL may draw on the processor, in which case CUDA need not be asked.
  reason = elsewhere(device, count);
#if !defined(ICLOTH_CUDA_EMULATED)  // the emulated device draws wherever OpenGL does
  if (gl_is_software()) return false;
#endif

  // CUDA lists the devices that the current context draws on. Where it cannot say, the probe
  // decides.
  std::array<int, 64> list{};
  unsigned listed = 0;
  const cudaError_t error = cudaGLGetDevices(
      &listed, list.data(), static_cast<unsigned>(list.size()), cudaGLDeviceListAll);
  if (error != cudaSuccess) {
    static_cast<void>(cudaGetLastError());
    return gl_is_nvidia();
  }
  const auto end = list.begin() + std::min<std::size_t>(listed, list.size());
  return std::find(list.begin(), end, device) != end;
}

bool interop_works(int device, std::string& reason) {
  if (!gl_runs_on_cuda(device, reason)) return false;
  clear_gl_errors();
  reason = probe(device);
  if (reason.empty() && glGetError() != GL_NO_ERROR) reason = "OpenGL reports an error of its own";
  clear_gl_errors();
  return reason.empty();
}

MadeWriter make_cuda_writer(const VertexFaces& faces, const VertexBuffers& buffers, int device) {
  std::string reason;
  if (!interop_works(device, reason)) return {nullptr, reason};
  return make_unprobed(faces, buffers, device);
}

}  // namespace icloth
