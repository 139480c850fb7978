// The CUDA devices of this machine. Everything here may be called in every build of the program;
// where it was built without CUDA there are none.
#pragma once

#include <string>
#include <vector>

namespace icloth {

/// One device as the driver describes it.
struct CudaDevice {
  int ordinal = 0;
  std::string name;
  int capability = 0;      ///< 10 · major + minor
  double memory = 0;       ///< [bytes]
  double free_memory = 0;  ///< [bytes]; 0 where the device cannot be used
  int multiprocessors = 0;
  double l2_cache = 0;  ///< [bytes]
  std::string problem;  ///< why the solver cannot run on it, in one line; empty: it can
};

struct CudaSystem {
  int driver = 0;   ///< highest CUDA version the driver knows, 1000 · major + 10 · minor; 0: none
  int runtime = 0;  ///< CUDA version of this program, in that form; 0: built without CUDA
  std::string problem;  ///< why there are no devices; empty when there are
  std::vector<CudaDevice> devices;
};

/// Asks driver and devices; starts up each usable device, which takes a moment.
CudaSystem cuda_system();

/// Devices that the driver shows; when 0, `reason` (may be null) says why in one line.
int cuda_device_count(std::string* reason = nullptr);

/// Whether the solver can run on the device; if not, `reason` (may be null) says why in one line.
bool cuda_device_usable(int ordinal, std::string* reason = nullptr);

/// The driver's name for one of the devices that it shows.
std::string cuda_device_name(int ordinal);

/// Bytes a second, read and written together, of copies within the memory of a usable device: best
/// of a few over buffers that exceed its caches. Takes some hundredths of a second.
double measure_copy_bandwidth(int ordinal);

/// The device that Build::cuda32 means from now on, in make_simulator and build_available; 0 until
/// it is set. Not checked here.
void set_cuda_device(int ordinal);
int cuda_device();

}  // namespace icloth
