#include "sim/cuda_devices.h"

#include <atomic>

#include "sim/files/error.h"

#if defined(ICLOTH_HAS_CUDA)
// Defined in sim/cuda/device_query.cu.
namespace icloth::cuda32 {
CudaSystem query_system();
int count_devices(std::string* reason);
bool is_device_usable(int ordinal, std::string* reason);
std::string name_of_device(int ordinal);
double copy_bandwidth(int ordinal);
}  // namespace icloth::cuda32
#endif

namespace icloth {
namespace {

std::atomic<int> chosen_device{0};

#if !defined(ICLOTH_HAS_CUDA)
constexpr char kWithoutCuda[] = "no device: this program was built without CUDA";
#endif

}  // namespace

void set_cuda_device(int ordinal) { chosen_device = ordinal; }
int cuda_device() { return chosen_device; }

#if defined(ICLOTH_HAS_CUDA)

CudaSystem cuda_system() { return cuda32::query_system(); }
int cuda_device_count(std::string* reason) { return cuda32::count_devices(reason); }
bool cuda_device_usable(int ordinal, std::string* reason) {
  return cuda32::is_device_usable(ordinal, reason);
}
std::string cuda_device_name(int ordinal) { return cuda32::name_of_device(ordinal); }
double measure_copy_bandwidth(int ordinal) { return cuda32::copy_bandwidth(ordinal); }

#else

CudaSystem cuda_system() {
  CudaSystem system;
  system.problem = kWithoutCuda;
  return system;
}
int cuda_device_count(std::string* reason) {
  if (reason) *reason = kWithoutCuda;
  return 0;
}
bool cuda_device_usable(int, std::string* reason) { return cuda_device_count(reason) > 0; }
std::string cuda_device_name(int) { throw DeviceError(kWithoutCuda); }
double measure_copy_bandwidth(int) { throw DeviceError(kWithoutCuda); }

#endif

}  // namespace icloth
