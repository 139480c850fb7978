#include "app/cli/commands/view.h"

#include "app/window/viewer.h"
#include "sim/files/error.h"
#include "sim/scene/scene_io.h"

namespace icloth {

int run_view(const ViewOptions& options) {
  const SimulationOptions& simulation = options.simulation;
  const Build build = choose_build(simulation);
  std::string reason;
  if (!build_available(build, &reason))
    throw DeviceError(std::string(build_name(build)) + " is not available: " + reason);

  Viewer viewer(options, build, load_scene(simulation.scene, scene_overrides(simulation)));
  viewer.run();
  return 0;
}

}  // namespace icloth
