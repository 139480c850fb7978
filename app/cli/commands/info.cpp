#include "app/cli/commands/info.h"

#include <cstdio>
#include <stdexcept>

#include "app/common/machine.h"
#include "app/common/options.h"
#include "kernels/parallel/device_problem.h"
#include "sim/cuda_devices.h"
#include "sim/files/assets.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#if defined(ICLOTH_HAS_RENDER)
#include "render/gl_context.h"
#endif

namespace icloth {
namespace {

/// Prints one CUDA device, whether it can be used or not.
void print_device(const CudaDevice& device) {
  const std::string name = "cuda:" + std::to_string(device.ordinal);
  std::printf("%-13s %s, compute capability %s, %d SMs, L2 %.1f MB, ", name.c_str(),
              device.name.c_str(), capability_text(device.capability).c_str(),
              device.multiprocessors, device.l2_cache / 1e6);
  if (!device.problem.empty()) {
    std::printf("memory %.1f GB\n%-13s not usable: %s\n", device.memory / 1e9, "",
                device.problem.c_str());
    return;
  }

  // Measuring the bandwidth takes memory of the device.
  double bandwidth = 0;
  try {
    bandwidth = measure_copy_bandwidth(device.ordinal);
  } catch (const std::runtime_error&) {
    // Its memory may be full; the rest is still worth knowing.
  }
  std::printf("memory %.1f GB (%.1f free), copies %.1f GB/s\n", device.memory / 1e9,
              device.free_memory / 1e9, bandwidth / 1e9);
}

void print_cuda() {
  const CudaSystem system = cuda_system();
  if (!system.problem.empty()) {
    std::printf("CUDA          %s\n", system.problem.c_str());
    return;
  }
  std::printf("CUDA          driver %s, runtime %s\n", cuda_version_text(system.driver).c_str(),
              cuda_version_text(system.runtime).c_str());
  for (const CudaDevice& device : system.devices) print_device(device);
}

}  // namespace

int run_info() {
  // The program and the machine come first, as every report of a problem needs them.
  std::printf("icloth        %s (%s)\n", program_version().c_str(), program_commit().c_str());
  std::printf("compiler      %s\n", compiler_name().c_str());
  std::printf("processor     %s, %d threads\n", processor_name().c_str(), processor_threads());
  std::printf("memory        %.1f GB, %.1f GB/s\n", memory_bytes() / 1e9,
              measure_memory_bandwidth() / 1e9);
  std::printf("assets        %s\n", assets_folder().c_str());

  // The first usable CUDA device is the one that cuda32 stands for.
  choose_build({});
  for (const Build build : {Build::cpu32, Build::cpu64, Build::cuda32}) {
    std::string reason;
    const bool available = build_available(build, &reason);
    std::printf("%-13s %s\n", std::string(build_name(build)).c_str(),
                available ? "available" : ("not available: " + reason).c_str());
  }

  print_cuda();

// The window and the renderer may have been left out when the program was built.
#if defined(ICLOTH_HAS_WINDOW)
  std::printf("window        built in\n");
#else
  std::printf("window        not built in: GLFW, Dear ImGui or OpenGL was missing\n");
#endif
#if defined(ICLOTH_HAS_RENDER)
  std::printf("%s", gl_info().c_str());
#else
  std::printf("renderer      not built in: OpenGL, EGL or glad was missing\n");
#endif
  return 0;
}

}  // namespace icloth
