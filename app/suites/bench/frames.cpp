#include "app/suites/bench/frames.h"

#include "app/common/headless.h"
#include "app/common/progress.h"
#include "sim/scene/scene_io.h"

namespace icloth {

Frames::Frames(Build build, const std::string& scene, const std::vector<std::string>& overrides,
               long first, long last, long every, const std::function<void()>& watch)
    : simulator_(make_simulator(build, load_scene(scene, overrides))),
      own_(simulator_->parameters()) {
  simulator_->report_energies(false);

  // The run itself; states are kept at regular steps.
  Progress progress(scene, last, static_cast<bool>(watch));
  for (long step = 0; step < last; ++step) {
    if (step >= first && (step - first) % every == 0) states_.push_back(simulator_->snapshot());
    reports_.push_back(simulator_->step({}));
    progress.update(step + 1);
    if (watch) watch();
  }
  progress.finish();
}

StepReport Frames::step(const Snapshot& state, const std::function<void(Parameters&)>& change) {
  // Every step starts from the same state, with the scene's own parameters but for the change.
  simulator_->restore(state);
  Parameters parameters = own_;
  change(parameters);
  simulator_->set_parameters(parameters);
  return simulator_->step({});
}

std::size_t Frames::penetrations() const { return count_penetrations(*simulator_); }

}  // namespace icloth
