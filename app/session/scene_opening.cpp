#include "app/session/scene_opening.h"

#include <utility>

namespace icloth {
namespace {

constexpr auto kPublishInterval = std::chrono::milliseconds(15);  // a screen shows no more

}  // namespace

SceneOpening::SceneOpening(Open open) : thread_([this, open = std::move(open)] { run(open); }) {}

SceneOpening::~SceneOpening() {
  cancel();
  thread_.join();
}

std::shared_ptr<const Scene> SceneOpening::scene() const {
  if (failure_) std::rethrow_exception(failure_);
  return scene_;
}

void SceneOpening::run(const Open& open) {
  try {
    scene_ = open(origin_, [this](const Simulator& simulator, const DressingStatus& status) {
      return watch(simulator, status);
    });
  } catch (const DressingCancelled&) {
    // There is no scene, as the user wanted.
  } catch (...) {
    failure_ = std::current_exception();
  }
  done_ = true;
}

/// Publishes where the garment is, as often as a screen can show it.
bool SceneOpening::watch(const Simulator& simulator, const DressingStatus& status) {
  // Each garment is put on in a scene of its own, hence in another world.
  const bool is_new_garment = status.step == 1 && !status.settling;
  if (is_new_garment) {
    world_ = std::make_shared<const World>(make_world(simulator.scene()));
    cameras_ = simulator.scene().cameras;
  }

  // Most steps are not seen, but each of them asks whether to go on.
  const Clock::time_point now = Clock::now();
  if (!is_new_garment && now - last_published_ < kPublishInterval) return !cancelled_;
  last_published_ = now;

  DressingPicture& picture = pictures_.back();
  picture.world = world_;
  picture.cameras = cameras_;
  simulator.positions(picture.positions);
  picture.garment = status.garment;
  picture.settling = status.settling;
  picture.step = status.step;
  picture.most_steps = status.most_steps;
  picture.largest_strain = status.largest_strain;
  pictures_.publish();
  return !cancelled_;
}

}  // namespace icloth
