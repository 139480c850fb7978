#include "app/cli/commands/view.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/common/headless.h"
#include "app/common/recording_file.h"
#include "app/window/start_screen.h"
#include "app/window/viewer.h"
#include "render/gl_context.h"
#include "sim/files/error.h"
#include "sim/garment/open_scene.h"
#include "sim/scene/input.h"

namespace icloth {
namespace {

std::unique_ptr<SceneOpening> start_opening(const SimulationOptions& options) {
  return std::make_unique<SceneOpening>([options](SceneOrigin& origin, const DressingWatch& watch) {
    return open_scene(options.scene, scene_overrides(options), &origin, watch,
                      scene_limits(options));
  });
}

/// In a window, cloth at rest is not computed. Settings that users give come later and count.
const std::string kWindowSetting = "step.sleep=on";

/// The options for a scene: what was said about the first one's parameters does not fit another.
ViewOptions options_for(const ViewOptions& first, const std::string& scene) {
  ViewOptions options = first;
  if (scene == first.simulation.scene) return options;
  options.simulation.scene = scene;
  options.simulation.overrides = {kWindowSetting};
  options.simulation.preset.clear();
  options.simulation.repair_start = false;
  return options;
}

/// One window, in which one scene after the other is opened.
class WindowProgram {
 public:
  WindowProgram(const ViewOptions& options, Build build)
      : first_(options),
        build_(build),
        window_("icloth", options.width, options.height),
        ui_(window_),
        screen_(window_, ui_, options.screenshot_folder) {
    set_thread_count(solver_threads(options.simulation));
  }

  /// Ends when the window is closed. Throws what opening the first scene throws; the others come
  /// from the list of the window, which says what is wrong.
  void run() {
    std::optional<std::string> next = first_.choose ? screen_.choose("") : open(first_);
    while (next) {
      try {
        next = open(options_for(first_, *next));
      } catch (const InputError& error) {
        next = screen_.choose(error.what(), *next);
      } catch (const DeviceError& error) {
        next = screen_.choose(error.what(), *next);
      }
    }
    window_.hide();
    leave_abandoned();
  }

 private:
  /// Opens a scene and runs it; returns the name of the next one, none where the window was closed.
  std::optional<std::string> open(const ViewOptions& options) {
    if (is_recording(options.simulation.scene)) return open_recording(options);
    return open_scene_of(options, build_, {});
  }

  /// Opens the scene of a recording on its build, and makes its steps again.
  std::optional<std::string> open_recording(const ViewOptions& options) {
    const std::string& path = options.simulation.scene;
    const bool is_set = !options.simulation.preset.empty() || options.simulation.repair_start ||
                        options.simulation.overrides.size() > 1;  // kWindowSetting is the first
    if (is_set)
      throw InputError(path +
                       ": --set, --preset and --repair-start do not go with a recording, "
                       "which has settings of its own");

    // Another build would give other bits.
    const Recording recording = load_recording(path);
    const Build build = recorded_build(recording);
    std::string reason;
    if (!build_available(build, &reason))
      throw DeviceError(path + ": it was recorded on " + recording.build +
                        ", which is not available: " + reason);

    ViewOptions with_run = options;
    with_run.simulation.scene = recording.scene;
    with_run.simulation.overrides = recording.overrides;
    with_run.recorded = recording.steps;
    return open_scene_of(with_run, build,
                         [&](const Scene& scene) { check_recording(recording, scene, path); });
  }

  /// `check` throws what is wrong with a scene; empty: nothing is.
  std::optional<std::string> open_scene_of(const ViewOptions& options, Build build,
                                           const std::function<void(const Scene&)>& check) {
    auto opening = start_opening(options.simulation);
    const bool is_open = screen_.show(*opening, options.simulation.scene);
    if (!is_open) {
      abandoned_.push_back(std::move(opening));
      if (window_.should_close()) return std::nullopt;
      return screen_.choose("");
    }

    // The notes go to the terminal that the window was opened from, and into a panel.
    const std::shared_ptr<const Scene> scene = opening->scene();
    print_notes(opening->origin());
    if (check) check(*scene);
    Viewer viewer(window_, ui_, options, build, scene, std::move(opening->origin()));
    if (options.simulation.scene == last_scene_) viewer.look_from(last_camera_);
    if (const Camera* camera = screen_.chosen_camera()) viewer.look_from(*camera);
    std::optional<std::string> next = viewer.run();
    last_scene_ = options.simulation.scene;
    last_camera_ = viewer.camera();
    return next;
  }

  /// A search for a start that nobody waits for any more ends with the program. It writes nothing
  /// but the cache of drapes, whose files appear whole or not at all.
  void leave_abandoned() const {
    const auto is_busy = [](const auto& opening) { return !opening->done(); };
    if (std::ranges::none_of(abandoned_, is_busy)) return;
    std::fflush(nullptr);
    std::_Exit(0);
  }

  ViewOptions first_;
  Build build_;
  Window window_;
  Ui ui_;
  StartScreen screen_;
  std::string last_scene_;  ///< that was open, and from where it was seen
  Camera last_camera_;
  std::vector<std::unique_ptr<SceneOpening>> abandoned_;  ///< that may still be at work
};

}  // namespace

int run_view(const ViewOptions& options) {
  const Build build = choose_build(options.simulation);
  std::string reason;
  if (!build_available(build, &reason))
    throw DeviceError(std::string(build_name(build)) + " is not available: " + reason);
  ViewOptions in_window = options;
  std::vector<std::string>& overrides = in_window.simulation.overrides;
  overrides.insert(overrides.begin(), kWindowSetting);
  WindowProgram(in_window, build).run();
  return 0;
}

}  // namespace icloth
