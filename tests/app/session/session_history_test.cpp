// The history of a session: any state of a run comes back with the bits that it had, and a run that
// was left as well.
#include <gtest/gtest.h>

#include "tests/app/session/session_support.h"
#include "tests/support/sewn_sheets.h"

namespace icloth {
namespace {

using testing::event;
using testing::FakeOptions;
using testing::grab_of_face;
using testing::make;
using testing::make_real;
using testing::real_scene;
using testing::replay;
using testing::replay_with_real;
using testing::step;
using testing::two_sheets;
using testing::wait_for_step;
using testing::wait_until;

TEST(SessionHistory, GoesBackAndOnFromThere) {
  const auto session = make();
  step(*session, 2);
  const auto positions = session->state().positions;
  session->post(event(InputEvent::Kind::grab, 7, {1, 2, 3}));
  step(*session, 4);
  EXPECT_EQ(session->state().history, 6u);
  session->step_back(4);
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.rewinds == 1; }));
  EXPECT_EQ(session->state().step, 2);
  EXPECT_TRUE(session->state().handles.empty());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    EXPECT_EQ(session->state().positions[v], positions[v]);
  }
  step(*session, 2);
  session->stop();
  EXPECT_EQ(session->recording().steps.size(), 4u);
  EXPECT_EQ(replay(session->recording()), session->recording().final_hash);
}

TEST(SessionHistory, HoldsParkedHandlesThroughAStepBack) {
  const auto session = make();
  session->post(event(InputEvent::Kind::grab, 3, {1, 2, 3}));
  step(*session, 3);
  session->set("step.time_step", 0.02);
  step(*session, 2);
  session->step_back();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.rewinds == 1; }));
  ASSERT_EQ(session->state().handles.size(), 1u);
  EXPECT_EQ(session->state().handles[0].id, 3);
  step(*session, 2);
  EXPECT_EQ(session->state().handles.size(), 1u);
  session->stop();
  EXPECT_EQ(replay(session->recording()), session->recording().final_hash);
}

TEST(SessionHistory, ResetsAndKeepsTheParameters) {
  const auto session = make();
  session->set("gravity.y", -2);
  step(*session, 3);
  session->reset();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.rewinds == 1; }));
  EXPECT_EQ(session->state().step, 0);
  EXPECT_EQ(session->state().history, 0u);
  EXPECT_DOUBLE_EQ(session->state().parameters.gravity.y, -2);
  step(*session);
  session->stop();
  const Recording recording = session->recording();
  ASSERT_EQ(recording.steps.size(), 1u);
  ASSERT_EQ(recording.steps[0].parameters.size(), 1u) << "the kept value must be recorded again";
  EXPECT_EQ(replay(recording), recording.final_hash);
}

/// Goes to a step and waits until the session is there.
void go(Session& session, std::size_t steps) {
  const std::uint64_t before = session.state().rewinds;
  session.go(steps);
  ASSERT_TRUE(wait_until(session, [&](const PublishedState& s) {
    return s.rewinds > before && s.history == steps && !s.preview;
  }));
}

/// Steps with a grab and a change of a parameter on the way; the positions after each of them.
std::vector<std::vector<Vec3f>> eventful_run(Session& session, int steps) {
  std::vector<std::vector<Vec3f>> seen{session.state().positions};
  for (int k = 0; k < steps; ++k) {
    if (k == 7) session.post(event(InputEvent::Kind::grab, 1, {0.2, 1.5, 0}));
    if (k == 23) session.set("step.time_step", 0.005);
    if (k == 31) session.post(event(InputEvent::Kind::release, 1, {}));
    step(session);
    seen.push_back(session.state().positions);
  }
  return seen;
}

TEST(SessionHistory, ReachesAllStatesInBoundedMemory) {
  SessionOptions options;
  options.history_bytes = 100'000;
  const auto session = make({.vertices = 300}, options);  // 14.4 kB a state
  const auto seen = eventful_run(*session, 60);
  EXPECT_LE(session->state().history_bytes, options.history_bytes);
  EXPECT_EQ(session->state().history, 60u);

  // Back and forth, the states are those that they were.
  for (const std::size_t steps : {59u, 24u, 23u, 60u, 8u, 0u, 33u, 60u}) {
    go(*session, steps);
    EXPECT_TRUE(session->state().positions == seen[steps]) << steps;
    EXPECT_EQ(session->state().ahead, 60 - steps);
    EXPECT_LE(session->state().history_bytes, options.history_bytes);
  }
  session->stop();
  EXPECT_EQ(session->recording().steps.size(), 60u);
  EXPECT_EQ(replay(session->recording(), {.vertices = 300}), session->recording().final_hash);
}

TEST(SessionHistory, ShowsOlderStatesWithoutGoingThere) {
  const auto session = make();
  const auto seen = eventful_run(*session, 12);
  session->preview(5);
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.preview; }));
  EXPECT_TRUE(session->state().positions == seen[5]);
  EXPECT_EQ(session->state().step, 5);
  EXPECT_EQ(session->state().history, 12u);

  // The present state is shown again at its own place, and the run goes on from it.
  session->preview(12);
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return !s.preview; }));
  EXPECT_TRUE(session->state().positions == seen[12]);
  step(*session);
  EXPECT_EQ(session->state().step, 13);
}

TEST(SessionHistory, ReturnsToTheRunThatWasLeft) {
  const auto session = make();
  const auto seen = eventful_run(*session, 40);
  go(*session, 10);
  step(*session, 3);
  EXPECT_EQ(session->state().ahead, 0u);
  EXPECT_EQ(session->state().left, 30u);
  const auto other = session->state().positions;

  // To the end of the first run, and then to that of the second one.
  for (int turn = 0; turn < 2; ++turn) {
    session->return_to_left_run();
    ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.history == 40 && s.left == 3; }));
    EXPECT_TRUE(session->state().positions == seen[40]);
    session->return_to_left_run();
    ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.history == 13; }));
    EXPECT_TRUE(session->state().positions == other);
  }

  // A reset leaves a run as well.
  session->reset();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.history == 0; }));
  EXPECT_EQ(session->state().left, 13u);
  session->return_to_left_run();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.history == 13; }));
  EXPECT_TRUE(session->state().positions == other);
  session->stop();
  EXPECT_EQ(replay(session->recording()), session->recording().final_hash);
}

TEST(SessionHistory, StopsMakingStepsAgainWhenSomethingIsAskedFor) {
  SessionOptions options;
  options.history_bytes = 1;  // the first state and the newest one
  const auto session = make({.step_ms = 20}, options);
  step(*session, 40);
  session->go(20);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  session->pause();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.rewinds == 1; }));
  EXPECT_LT(session->state().history, 20u);
  EXPECT_EQ(session->state().history + session->state().ahead, 40u);
}

TEST(SessionHistory, GoingBackUndoesThatAStepWasPassedOver) {
  const FakeOptions options{.refuse = 2, .refuse_above = 0.006};
  const auto session = make(options);
  session->set_real_time(false);
  session->play();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.failed; }));
  session->pass_over();
  ASSERT_TRUE(wait_for_step(*session, 3));
  session->step_back();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.step == 2; }));
  session->set("step.time_step", 0.005);
  step(*session, 2);
  session->stop();
  EXPECT_EQ(session->recording().steps.size(), 4u);
  EXPECT_EQ(replay(session->recording(), options), session->recording().final_hash);
}

// ---- with a real solver ------------------------------------------------------------------------

void go_back(Session& session, std::size_t count) {
  const std::uint64_t rewinds = session.state().rewinds + 1;
  session.step_back(count);
  ASSERT_TRUE(wait_until(session, [=](const auto& s) { return s.rewinds == rewinds; }));
}

TEST(SessionHistory, ShowsStatesFromBeforeAndAfterAWeld) {
  const std::shared_ptr<const Scene> scene = two_sheets(0.03);
  const auto session =
      std::make_unique<Session>(make_simulator(Build::cpu32, scene), SessionOptions{});
  session->set_real_time(false);
  const auto start = session->state().positions;
  session->play();
  ASSERT_TRUE(wait_until(*session, [](const PublishedState& s) { return s.notes > 0; }));
  EXPECT_NE(session->state().note.find("welded"), std::string::npos) << session->state().note;
  session->pause();
  ASSERT_TRUE(wait_until(*session, [](const PublishedState& s) { return !s.playing; }));
  step(*session, 2);

  // The solver has fewer vertices since, and the picture as many as before.
  const auto shown = [&](std::size_t steps) {
    const auto number = static_cast<std::int64_t>(steps);
    session->preview(steps);
    EXPECT_TRUE(wait_until(*session,
                           [&](const PublishedState& s) { return s.preview && s.step == number; }));
    return session->state().positions;
  };
  EXPECT_EQ(shown(session->state().history - 1).size(), start.size());
  EXPECT_TRUE(shown(0) == start);
}

TEST(SessionHistory, ReplaysToTheSameBitsAfterGoingBackWithHands) {
  const auto session = make_real();
  session->set_scripted(true);
  step(*session, 3);
  session->post(grab_of_face(1, 5, {0, 0.25, 0}));
  step(*session, 4);
  session->post(event(InputEvent::Kind::move, 1, {0.1, 0.3, 0}));
  step(*session, 8);
  go_back(*session, 6);
  EXPECT_EQ(session->state().handles.size(), 2u);
  session->post(event(InputEvent::Kind::move, 1, {-0.1, 0.3, 0}));
  step(*session, 5);
  session->set_scripted(false);
  step(*session, 3);
  go_back(*session, 6);
  step(*session, 4);
  EXPECT_EQ(session->state().handles.size(), 1u) << "the scene's own grabs are switched off";
  session->stop();
  EXPECT_EQ(session->recording().steps.size(), 15u);
  EXPECT_EQ(replay_with_real(session->recording()), session->recording().final_hash);
}

/// Going back and making the same steps again is the same as never having gone back.
TEST(SessionHistory, TheSameStepsAfterGoingBackEndInTheSameState) {
  const auto straight = make_real(), detour = make_real();
  for (const auto& session : {straight.get(), detour.get()}) {
    session->post(grab_of_face(1, 5, {0, 0.25, 0}));
    step(*session, 6);
  }
  step(*detour, 5);
  go_back(*detour, 5);
  for (const auto& session : {straight.get(), detour.get()}) {
    step(*session, 8);
    session->stop();
  }
  EXPECT_EQ(detour->recording().final_hash, straight->recording().final_hash);
}

TEST(SessionHistory, SettingsTriedBetweenTwoStepsLeaveNoTrace) {
  const auto straight = make_real(), tried = make_real();
  for (int k = 0; k < 12; ++k) {
    tried->set("proximity.thickness", 0.004);
    tried->set("proximity.thickness", straight->state().parameters.proximity.thickness);
    step(*straight);
    step(*tried);
  }
  straight->stop();
  tried->stop();
  EXPECT_EQ(tried->recording().final_hash, straight->recording().final_hash);
  EXPECT_EQ(replay_with_real(tried->recording()), tried->recording().final_hash);
}

TEST(SessionHistory, ReplaysToTheSameBitsWhenSettingsChangedBeforeGoingBack) {
  const auto session = make_real();
  step(*session, 5);
  session->set("proximity.thickness", 0.003);
  step(*session, 5);
  go_back(*session, 7);
  session->set("proximity.thickness", 0.002);
  step(*session, 2);
  session->set("proximity.thickness", 0.003);
  step(*session, 6);
  session->stop();
  EXPECT_EQ(replay_with_real(session->recording()), session->recording().final_hash);
}

TEST(SessionHistory, GoesOnFromARunThatWasRecordedBefore) {
  const auto first = make_real();
  first->post(grab_of_face(1, 5, {0, 0.25, 0}));
  step(*first, 4);
  first->set("gravity.y", -3);
  step(*first, 4);
  first->stop();
  const Recording recorded = first->recording();

  // All of it lies ahead, and its end has its settings and its hand.
  SessionOptions options;
  options.ahead = recorded.steps;
  Session second(make_simulator(Build::cpu32, real_scene()), options);
  EXPECT_EQ(second.state().ahead, 8u);
  second.go(8);
  ASSERT_TRUE(wait_until(second, [](const auto& s) { return s.step == 8 && s.rewinds > 0; }));
  EXPECT_EQ(second.state().report.state_hash, recorded.final_hash);
  EXPECT_DOUBLE_EQ(second.state().parameters.gravity.y, -3);
  EXPECT_EQ(second.state().handles.size(), 1u);

  // What comes then is one run with it.
  step(second, 2);
  second.stop();
  EXPECT_EQ(second.recording().steps.size(), 10u);
  EXPECT_EQ(replay_with_real(second.recording()), second.recording().final_hash);
}

TEST(SessionHistory, ReplaysToTheSameBitsAfterReset) {
  const auto session = make_real();
  session->post(grab_of_face(1, 5, {0, 0.25, 0}));
  session->set("gravity.y", -8);
  step(*session, 6);
  const std::uint64_t rewinds = session->state().rewinds;
  session->reset();
  ASSERT_TRUE(wait_until(*session, [=](const auto& s) { return s.rewinds > rewinds; }));
  EXPECT_TRUE(session->state().handles.empty());
  step(*session, 4);
  session->post(grab_of_face(2, 30, {0, 0.3, 0}));
  step(*session, 6);
  session->stop();
  EXPECT_EQ(session->recording().steps.size(), 10u);
  EXPECT_EQ(replay_with_real(session->recording()), session->recording().final_hash);
}

}  // namespace
}  // namespace icloth
