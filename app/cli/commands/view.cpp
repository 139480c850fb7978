#include "app/cli/commands/view.h"

#include <utility>

#include "app/common/dressing_progress.h"
#include "app/common/headless.h"
#include "app/window/viewer.h"
#include "sim/files/error.h"
#include "sim/garment/open_scene.h"

namespace icloth {

int run_view(const ViewOptions& options) {
  const SimulationOptions& simulation = options.simulation;
  const Build build = choose_build(simulation);
  std::string reason;
  if (!build_available(build, &reason))
    throw DeviceError(std::string(build_name(build)) + " is not available: " + reason);

  // The notes go to the terminal that the window was opened from, and into a panel.
  SceneOrigin origin;
  const std::shared_ptr<const Scene> scene =
      open_scene(simulation.scene, scene_overrides(simulation), &origin,
                 show_dressing(simulation.quiet), scene_limits(simulation));
  print_notes(origin);
  Viewer viewer(options, build, scene, std::move(origin));
  viewer.run();
  return 0;
}

}  // namespace icloth
