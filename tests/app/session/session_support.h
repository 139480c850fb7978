// A session of a simulator, used as the window uses it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "app/common/headless.h"
#include "app/session/session.h"
#include "tests/support/fake_simulator.h"

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

}  // namespace icloth::testing
