#include "app/cli/commands/view.h"

#include "app/window/viewer.h"
#include "sim/files/error.h"
#include "sim/scene/scene_io.h"

namespace icloth {

int run_view(const ViewOptions& options) {
  std::string reason;
  if (!build_available(options.build, &reason)) {
    throw DeviceError(std::string(build_name(options.build)) + " is not available: " + reason);
  }
  Viewer viewer(options, load_scene(options.scene, options.overrides));
  viewer.run();
  return 0;
}

}  // namespace icloth
