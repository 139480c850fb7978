// A session of a simulator, used as the window uses it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "app/common/headless.h"
#include "app/session/session.h"
#include "tests/support/fake_simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth::testing {

/// Looks at the session as the window does until the condition holds; false after 5 s.
inline bool wait_until(Session& session,
                       const std::function<bool(const PublishedState&)>& condition) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(5);
  while (Clock::now() < end) {
    session.take();
    if (condition(session.state())) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

inline bool wait_for_step(Session& session, std::int64_t step) {
  return wait_until(session, [=](const PublishedState& s) { return s.step >= step; });
}

/// Runs single steps and waits for each.
inline void step(Session& session, int count = 1) {
  for (int k = 0; k < count; ++k) {
    const std::int64_t next = session.state().step + 1;
    session.step_once();
    ASSERT_TRUE(wait_for_step(session, next));
  }
}

inline InputEvent event(InputEvent::Kind kind, int handle, Vec3d target) {
  InputEvent e;
  e.kind = kind;
  e.handle = handle;
  e.target = target;
  return e;
}

/// Runs a recording as `icloth replay` does, and returns the hash of the state at the end.
inline std::uint64_t replay(const Recording& recording, Simulator& simulator) {
  for (const Recording::Step& s : recording.steps) {
    Parameters parameters = simulator.parameters();
    apply_changes(s, parameters);
    if (!s.parameters.empty()) simulator.set_parameters(parameters);
    const bool accepted = simulator.step(s.events).accepted;
    if (!accepted && s.passed_over) simulator.pass_over();
  }
  return simulator.state_hash();
}

inline std::uint64_t replay(const Recording& recording, FakeOptions options = {}) {
  FakeSimulator simulator(options);
  return replay(recording, simulator);
}

inline std::unique_ptr<Session> make(FakeOptions options = {}, SessionOptions session = {}) {
  session.scene = "fake";
  return std::make_unique<Session>(std::make_unique<FakeSimulator>(options), session);
}

/// For a real solver: two sheets that start closer than the thickness, over a ball, and a hand of
/// the scene's own.
inline std::shared_ptr<const Scene> real_scene() {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->cloths.push_back(make_sheet(lying(0.3, 120), {0.01, 0.112, 0.02}));
  scene->cloths.push_back(make_sheet(lying(0.3, 120), {0, 0.1123, 0}));
  scene->obstacles.push_back(make_obstacle(make_sphere(0.1, 320), {}));
  scene->parameters.implicit.integrator = Integrator::bdf2;
  ScriptedGrab grab;
  grab.vertex = 3;
  grab.release = 10;
  grab.path = {{0, {0.1, 0.2, 0}}, {1, {0.3, 0.4, 0.1}}};
  scene->input.push_back(grab);
  return scene;
}

inline std::unique_ptr<Session> make_real() {
  return std::make_unique<Session>(make_simulator(Build::cpu32, real_scene()), SessionOptions{});
}

inline std::uint64_t replay_with_real(const Recording& recording) {
  const auto simulator = make_simulator(Build::cpu32, real_scene());
  return replay(recording, *simulator);
}

inline InputEvent grab_of_face(int handle, Index face, Vec3d target) {
  InputEvent grab = event(InputEvent::Kind::grab, handle, target);
  grab.face = face;
  return grab;
}

}  // namespace icloth::testing
