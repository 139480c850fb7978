// Hands that are looked at now and then pull as if they were looked at all the time.
#include "app/session/hand_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "kernels/index.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/app/session/session_support.h"

namespace icloth {
namespace {

using Kind = InputEvent::Kind;
using testing::event;

constexpr double kStep = 1.0 / 120, kSpeed = 0.3;  // [s], [m/s]

/// A hand that is taken 0.3 m along z within a second, looked at every so many steps. Calls
/// `step(events)` for each of `steps` steps.
template <class Step>
void drag(const InputEvent& grab, int steps_a_look, int steps, const Step& step) {
  HandPaths hands;
  hands.post(grab, 0);
  for (int k = 0; k < steps; ++k) {
    const double time = k * kStep;
    if (k > 0 && k % steps_a_look == 0) {
      const double way = kSpeed * std::min(time, 1.0);
      hands.post(event(Kind::move, grab.handle, grab.target + Vec3d{0, 0, way}), time);
    }
    step(hands.events(time, kStep));
  }
}

/// Where a hand pulls to in each step.
std::vector<double> places(int steps_a_look, int steps) {
  std::vector<double> z;
  drag(event(Kind::grab, 1, {}), steps_a_look, steps, [&](const std::vector<InputEvent>& events) {
    z.push_back(events.empty() ? z.back() : events.back().target.z);
  });
  return z;
}

TEST(HandPaths, MoveAlikeAtSixtyAndTenLooksASecond) {
  constexpr int kOften = 2, kSeldom = 12;
  const std::vector<double> often = places(kOften, 240), seldom = places(kSeldom, 240);

  // Each lags behind by one look; the first one also by where the hand was at its first look.
  for (std::size_t k = 2 * kSeldom; k < often.size(); ++k)
    EXPECT_NEAR(seldom[k], often[k - (kSeldom - kOften)], 1e-4) << "step " << k;
  EXPECT_DOUBLE_EQ(often.back(), kSpeed);
  EXPECT_DOUBLE_EQ(seldom.back(), kSpeed);

  // At no time does the hand jump.
  for (std::size_t k = 1; k < seldom.size(); ++k)
    EXPECT_LE(seldom[k] - seldom[k - 1], 1.001 * kSpeed * kStep) << "step " << k;
}

TEST(HandPaths, ArriveWithTheNextStepWhereStepsAreSeldom) {
  HandPaths hands;
  hands.post(event(Kind::grab, 1, {}), 0);
  EXPECT_EQ(hands.events(0, kStep).size(), 1u);

  // Many looks between two steps: only the newest place counts, and at once.
  for (int step = 1; step < 4; ++step) {
    for (int look = 0; look < 5; ++look)
      hands.post(event(Kind::move, 1, {step + 0.1 * look, 0, 0}), step * kStep);
    const auto events = hands.events(step * kStep, kStep);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_DOUBLE_EQ(events[0].target.x, step + 0.4);
  }
}

TEST(HandPaths, LetGoAtOnce) {
  HandPaths hands;
  hands.post(event(Kind::grab, 1, {}), 0);
  hands.events(0, kStep);
  hands.post(event(Kind::move, 1, {1, 0, 0}), 0.1);
  hands.events(0.1, kStep);
  hands.post(event(Kind::release, 1, {}), 0.1 + kStep);
  const auto events = hands.events(0.1 + kStep, kStep);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::release);
  EXPECT_TRUE(hands.events(0.2, kStep).empty());
}

TEST(HandPaths, MoveHandsThatWereHeldBeforeAJumpInTime) {
  HandPaths hands;
  hands.post(event(Kind::grab, 1, {}), 3);
  hands.clear();
  hands.post(event(Kind::move, 1, {1, 0, 0}), 2);
  hands.post(event(Kind::move, 1, {2, 0, 0}), 2);
  const auto events = hands.events(2, kStep);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::move);
  EXPECT_DOUBLE_EQ(events[0].target.x, 2);
}

TEST(HandPaths, CountAsArrivedForWhoDrawsThem) {
  HandPaths hands;
  hands.post(event(Kind::grab, 1, {}), 0);
  std::vector<HandleState> held;
  hands.apply_to(held);
  ASSERT_EQ(held.size(), 1u);

  hands.events(0, kStep);
  hands.post(event(Kind::move, 1, {1, 0, 0}), 0.1);
  hands.events(0.1, kStep);
  hands.apply_to(held);
  EXPECT_DOUBLE_EQ(held[0].target.x, 1);
}

// ---- cloth in the hands

/// A flag of 600 triangles in still air, away from everything.
std::shared_ptr<Scene> still_flag() {
  const std::vector<std::string> size = {"triangles=600"};
  auto scene = std::make_shared<Scene>(*load_scene("flag", size));
  scene->parameters.step.time_step = kStep;
  scene->parameters.wind = {};
  scene->obstacles.clear();
  scene->input.clear();
  return scene;
}

/// Takes the last face at its first corner.
InputEvent grab_of_last_face(const Simulator& simulator) {
  const std::vector<Triangle>& faces = simulator.scene().cloths[0].mesh.faces;
  return testing::grab_of_face(1, static_cast<Index>(faces.size()) - 1,
                               simulator.snapshot().x1[at(faces.back()[0])]);
}

/// A hand that is looked at less often lags behind by more. Without weight the cloth rests before
/// the drag, so that at the same place of the hand it must be the same cloth, then and when all
/// rests.
TEST(HandPaths, LeaveTheSameClothAtSixtyAndTenLooksASecond) {
  const auto scene = still_flag();
  scene->parameters.gravity = {.x = 0, .y = 0, .z = 0};
  constexpr int kOften = 2, kSeldom = 12;
  std::map<int, std::vector<std::vector<Vec3d>>> states;
  for (const int steps_a_look : {kOften, kSeldom}) {
    const auto simulator = make_simulator(Build::cpu32, scene);
    drag(grab_of_last_face(*simulator), steps_a_look, 240,
         [&](const std::vector<InputEvent>& events) {
           ASSERT_TRUE(simulator->step(events).accepted);
           states[steps_a_look].push_back(simulator->snapshot().x1);
         });
  }

  double largest = 0, moved = 0;
  for (std::size_t k = kSeldom - kOften; k < states[kSeldom].size(); ++k) {
    const auto& seldom = states[kSeldom][k];
    const auto& often = states[kOften][k - (kSeldom - kOften)];
    for (std::size_t v = 0; v < seldom.size(); ++v) {
      largest = std::max(largest, norm(seldom[v] - often[v]));
      moved = std::max(moved, norm(seldom[v] - states[kSeldom][0][v]));
    }
  }
  std::printf("largest distance %.3g mm\n", 1e3 * largest);
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(largest, 1e-3);
}

/// No vertex moves further in the first step without the hand than in the step before plus an edge.
TEST(HandPaths, LetGoWithoutAJerk) {
  const auto scene = still_flag();
  const auto simulator = make_simulator(Build::cpu32, scene);
  drag(grab_of_last_face(*simulator), 2, 120, [&](const std::vector<InputEvent>& events) {
    ASSERT_TRUE(simulator->step(events).accepted);
  });

  std::vector<std::vector<Vec3d>> states;
  states.push_back(simulator->snapshot().x1);
  simulator->step({});
  states.push_back(simulator->snapshot().x1);
  const InputEvent release = event(Kind::release, 1, {});
  simulator->step({{release}});
  states.push_back(simulator->snapshot().x1);

  // The longest edge of each vertex while it was held.
  std::vector<double> edge(states[1].size(), 0);
  for (const Triangle& t : scene->cloths[0].mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = at(t[k]), b = at(t[(k + 1) % 3]);
      const double length = norm(states[1][a] - states[1][b]);
      edge[a] = std::max(edge[a], length);
      edge[b] = std::max(edge[b], length);
    }
  for (std::size_t v = 0; v < edge.size(); ++v)
    EXPECT_LE(norm(states[2][v] - states[1][v]), norm(states[1][v] - states[0][v]) + edge[v])
        << "vertex " << v;
}

}  // namespace
}  // namespace icloth
