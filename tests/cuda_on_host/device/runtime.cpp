// The functions of the CUDA runtime: devices, streams, events and errors.
#include <chrono>
#include <utility>

#include "cuda_runtime.h"
#include "tests/cuda_on_host/device/complaint.h"
#include "tests/cuda_on_host/device/counts.h"
#include "tests/cuda_on_host/device/errors.h"
#include "tests/cuda_on_host/device/settings.h"
#include "tests/cuda_on_host/device/streams.h"

using cuda_on_host::device_mutex;
using cuda_on_host::DeviceLock;

// ---- errors -------------------------------------------------------------------------------------

namespace cuda_on_host {
namespace {
thread_local cudaError_t last_error = cudaSuccess;
}
cudaError_t fail(cudaError_t error) { return last_error = error; }

int resident_blocks_per_processor() { return static_cast<int>(settings().resident); }
}  // namespace cuda_on_host

cudaError_t cudaGetLastError() { return std::exchange(cuda_on_host::last_error, cudaSuccess); }

const char* cudaGetErrorString(cudaError_t error) {
  switch (error) {
    case cudaSuccess:
      return "no error";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    case cudaErrorInvalidDevice:
      return "invalid device ordinal";
    case cudaErrorNotSupported:
      return "operation not supported";
    default:
      return "an error of the emulated device";
  }
}
const char* cudaGetErrorName(cudaError_t error) {
  return error == cudaErrorMemoryAllocation ? "cudaErrorMemoryAllocation" : "cudaErrorEmulated";
}

// ---- devices ------------------------------------------------------------------------------------

namespace {

constexpr int kCudaVersion = 13000, kMajor = 9, kMinor = 0;
constexpr std::size_t kMemory = std::size_t{8} << 30;

cudaError_t check_ordinal(int device) {
  return device == 0 && cuda_on_host::settings().devices == 1
             ? cudaSuccess
             : cuda_on_host::fail(cudaErrorInvalidDevice);
}

int processors() { return static_cast<int>(cuda_on_host::settings().processors); }

}  // namespace

cudaError_t cudaGetDeviceCount(int* count) {
  *count = static_cast<int>(cuda_on_host::settings().devices);
  return *count > 0 ? cudaSuccess : cuda_on_host::fail(cudaErrorNoDevice);
}
cudaError_t cudaGetDevice(int* device) {
  *device = 0;
  return cudaSuccess;
}
cudaError_t cudaSetDevice(int device) { return check_ordinal(device); }

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
  if (check_ordinal(device) != cudaSuccess) return cudaErrorInvalidDevice;
  *properties = {};
  std::strcpy(properties->name, "emulated on the host");
  properties->major = kMajor;
  properties->minor = kMinor;
  properties->multiProcessorCount = processors();
  properties->l2CacheSize = 1 << 20;
  properties->totalGlobalMem = kMemory;
  return cudaSuccess;
}

cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr which, int device) {
  if (check_ordinal(device) != cudaSuccess) return cudaErrorInvalidDevice;

  // A recent device that can do all that the program asks for.
  switch (which) {
    case cudaDevAttrMultiProcessorCount:
      *value = processors();
      break;
    case cudaDevAttrComputeCapabilityMajor:
      *value = kMajor;
      break;
    case cudaDevAttrComputeCapabilityMinor:
      *value = kMinor;
      break;
    case cudaDevAttrCooperativeLaunch:
      *value = 1;
      break;
    case cudaDevAttrMemoryPoolsSupported:
      *value = 1;
      break;
    case cudaDevAttrComputeMode:
      *value = 0;
      break;
  }
  return cudaSuccess;
}

cudaError_t cudaDriverGetVersion(int* version) {
  *version = kCudaVersion;
  return cudaSuccess;
}
cudaError_t cudaRuntimeGetVersion(int* version) {
  *version = kCudaVersion;
  return cudaSuccess;
}
cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) {
  *free = std::size_t{64} << 20;  // little, as measure_copy_bandwidth takes what it can get
  *total = kMemory;
  return cudaSuccess;
}

cudaError_t cudaDeviceSynchronize() {
  const DeviceLock lock(device_mutex());
  ++cuda_on_host::counts().host_waits;
  cuda_on_host::wait_for_all_streams();
  return cudaSuccess;
}

// ---- streams and events -------------------------------------------------------------------------

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
  const DeviceLock lock(device_mutex());
  if (flags != cudaStreamNonBlocking)
    cuda_on_host::complain("streams that wait for the default stream are not emulated");
  *stream = cuda_on_host::create_stream();
  return cudaSuccess;
}
cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  const DeviceLock lock(device_mutex());
  cuda_on_host::destroy_stream(stream);
  return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  const DeviceLock lock(device_mutex());
  ++cuda_on_host::counts().host_waits;
  cuda_on_host::wait_for(cuda_on_host::stream_or_default(stream));
  return cudaSuccess;
}

/// The stream goes on when the other one has come to the event; an event that was never recorded
/// holds nobody up.
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned) {
  const DeviceLock lock(device_mutex());
  cuda_on_host::Stream* const other = event->stream;
  if (other == nullptr || other == &cuda_on_host::stream_or_default(stream)) return cudaSuccess;
  cuda_on_host::enqueue(stream, "wait for an event", [other, number = event->number] {
    cuda_on_host::wait_for(*other, number);
  });
  return cudaSuccess;
}

cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) {
  *event = new cuda_on_host::Event;
  return cudaSuccess;
}
cudaError_t cudaEventCreate(cudaEvent_t* event) { return cudaEventCreateWithFlags(event, 0); }
cudaError_t cudaEventDestroy(cudaEvent_t event) {
  delete event;
  return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  const DeviceLock lock(device_mutex());
  using Clock = std::chrono::steady_clock;
  event->stream = &cuda_on_host::stream_or_default(stream);
  event->time = std::make_shared<double>(0);
  event->number = cuda_on_host::enqueue(stream, "event", [time = event->time] {
    const auto now = Clock::now().time_since_epoch();
    *time = std::chrono::duration<double, std::milli>(now).count();
  });
  return cudaSuccess;
}
cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  const DeviceLock lock(device_mutex());
  ++cuda_on_host::counts().host_waits;
  if (event->stream != nullptr) cuda_on_host::wait_for(*event->stream, event->number);
  return cudaSuccess;
}
cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t start, cudaEvent_t end) {
  *milliseconds = static_cast<float>(*end->time - *start->time);
  return cudaSuccess;
}
