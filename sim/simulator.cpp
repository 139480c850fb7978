#include "sim/simulator.h"

#include <tbb/global_control.h>

#include "sim/error.h"
#include "sim/world.h"

// One solver a build; each is compiled from sim/solver.cpp in its own namespace.
namespace icloth::cpu32 {
std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world);
}
namespace icloth::cpu64 {
std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world);
}
#if defined(ICLOTH_HAS_CUDA)
namespace icloth::cuda32 {
std::unique_ptr<Simulator> make_solver(std::shared_ptr<const Scene> scene, World world);
/// `reason` (may be null) says in one line why there is no usable device.
bool device_usable(std::string* reason);
}  // namespace icloth::cuda32
#endif

namespace icloth {

std::string_view build_name(Build build) {
  switch (build) {
    case Build::cpu32:
      return "cpu32";
    case Build::cpu64:
      return "cpu64";
    case Build::cuda32:
      return "cuda32";
  }
  return "";
}

bool build_available(Build build, std::string* reason) {
  if (build != Build::cuda32) return true;
#if defined(ICLOTH_HAS_CUDA)
  return cuda32::device_usable(reason);
#else
  if (reason) *reason = "this program was built without CUDA";
  return false;
#endif
}

std::unique_ptr<Simulator> make_simulator(Build build, std::shared_ptr<const Scene> scene) {
  std::string reason;
  if (!build_available(build, &reason))
    throw DeviceError("no device for " + std::string(build_name(build)) + ": " + reason);
  if (scene->cloths.empty())
    throw InputError("scene '" + scene->name + "': no cloths, expected at least one");
  World world = make_world(*scene);
  switch (build) {
    case Build::cpu32:
      return cpu32::make_solver(std::move(scene), std::move(world));
    case Build::cpu64:
      return cpu64::make_solver(std::move(scene), std::move(world));
    case Build::cuda32:
#if defined(ICLOTH_HAS_CUDA)
      return cuda32::make_solver(std::move(scene), std::move(world));
#endif
      break;
  }
  throw DeviceError("no such build");
}

void set_thread_count(int threads) {
  static std::unique_ptr<tbb::global_control> limit;
  limit.reset();  // the smallest of all living limits counts
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
}

}  // namespace icloth
