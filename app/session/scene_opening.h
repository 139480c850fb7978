// A scene on its way to the window: read and dressed on a thread of its own, while the window shows
// how far it is.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/session/triple_buffer.h"
#include "sim/garment/dressing.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/world.h"

namespace icloth {

/// A moment of dressing. Before the first one the scene is read, and a start without intersections
/// is looked for.
struct DressingPicture {
  /// The scene in which a garment is put on, another one for each garment; null: not begun.
  std::shared_ptr<const World> world;
  std::vector<CameraPose> cameras;  ///< of the scene
  std::vector<Vec3f> positions;     ///< all vertices of that world [m]
  std::string garment;              ///< name of its cloth
  bool settling = false;            ///< under its weight; else its seams are drawn together
  int step = 0, most_steps = 0;
  double largest_strain = 0;  ///< outside gathers
};

/// Every public member is called from the interface thread and returns at once, apart from the
/// destructor, which waits for the thread.
class SceneOpening {
 public:
  /// Opens the scene, fills the origin, and calls the watch after every step of dressing.
  using Open = std::function<std::shared_ptr<const Scene>(SceneOrigin&, const DressingWatch&)>;

  explicit SceneOpening(Open open);
  ~SceneOpening();
  SceneOpening(const SceneOpening&) = delete;
  SceneOpening& operator=(const SceneOpening&) = delete;

  /// Dressing ends after the step in progress; what comes before it cannot be interrupted.
  void cancel() { cancelled_ = true; }
  bool done() const { return done_; }

  /// Moves picture() to the newest one; false when there is none since the last call.
  bool take() { return pictures_.take(); }
  const DressingPicture& picture() const { return pictures_.front(); }

  /// Once it is done: the scene, null where it was cancelled. Throws what opening it has thrown.
  std::shared_ptr<const Scene> scene() const;
  SceneOrigin& origin() { return origin_; }

 private:
  using Clock = std::chrono::steady_clock;

  void run(const Open& open);
  bool watch(const Simulator& simulator, const DressingStatus& status);

  std::atomic<bool> cancelled_{false}, done_{false};
  TripleBuffer<DressingPicture> pictures_;

  // The thread writes these; the other one reads them when it is done.
  std::shared_ptr<const Scene> scene_;
  SceneOrigin origin_;
  std::exception_ptr failure_;

  // Only the thread uses these.
  std::shared_ptr<const World> world_;
  std::vector<CameraPose> cameras_;
  Clock::time_point last_published_{};

  std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace icloth
