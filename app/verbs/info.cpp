#include "app/verbs/info.h"

#include <cstdio>

#include "app/machine.h"
#include "sim/scene_io.h"
#include "sim/simulator.h"
#if defined(ICLOTH_HAS_RENDER)
#include "render/gl_context.h"
#endif

namespace icloth {

int run_info() {
  std::printf("icloth        %s (%s)\n", program_version().c_str(), program_commit().c_str());
  std::printf("compiler      %s\n", compiler_name().c_str());
  std::printf("processor     %s, %d threads\n", processor_name().c_str(), processor_threads());
  std::printf("memory        %.1f GB, %.1f GB/s\n", memory_bytes() / 1e9,
              measure_memory_bandwidth() / 1e9);
  std::printf("assets        %s\n", assets_folder().c_str());
  for (const Build build : {Build::cpu32, Build::cpu64, Build::cuda32}) {
    std::string reason;
    const bool available = build_available(build, &reason);
    std::printf("%-13s %s\n", std::string(build_name(build)).c_str(),
                available ? "available" : ("not available: " + reason).c_str());
  }
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
