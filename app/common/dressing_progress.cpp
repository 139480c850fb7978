#include "app/common/dressing_progress.h"

#include <chrono>

#include "app/common/progress.h"
#include "sim/files/text.h"

namespace icloth {

DressingWatch show_dressing(bool quiet) {
  // Copies of a watch share one line. Closing and settling are runs of their own.
  auto line = std::make_shared<std::unique_ptr<Progress>>();
  return [line, quiet](const Simulator&, const DressingStatus& status) {
    if (status.step == 1)
      *line = std::make_unique<Progress>(
          excerpt(status.garment) + (status.settling ? " settles" : " draws its seams together"),
          status.most_steps, quiet);
    (*line)->update(status.step);
    return true;
  };
}

std::shared_ptr<const Scene> open_scene_showing(const std::string& argument,
                                                std::span<const std::string> overrides,
                                                SceneOrigin& origin, bool quiet,
                                                const SceneLimits& limits) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  int steps = 0;
  const auto watch = [&, show = show_dressing(quiet)](const Simulator& simulator,
                                                      const DressingStatus& status) {
    ++steps;
    return show(simulator, status);
  };
  std::shared_ptr<const Scene> scene = open_scene(argument, overrides, &origin, watch, limits);

  const std::chrono::duration<double> time = Clock::now() - begin;
  if (steps > 0)
    origin.notes.push_back("the garments were put on in " + std::to_string(steps) + " steps and " +
                           rounded_text(time.count()) +
                           " s, before the steps that the statistics count");
  return scene;
}

}  // namespace icloth
