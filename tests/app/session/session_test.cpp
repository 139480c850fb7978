// The session: nothing waits for the solver, and what was done can be done again.
#include "app/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/app/session/session_support.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::FakeSimulator;
using Clock = std::chrono::steady_clock;
using testing::event;
using testing::FakeOptions;
using testing::make;
using testing::replay;
using testing::step;
using testing::wait_for_step;
using testing::wait_until;

TEST(Session, PublishesTheStartStateAtOnce) {
  const auto session = make();
  EXPECT_EQ(session->state().positions.size(), 12u);
  EXPECT_EQ(session->state().step, 0);
  EXPECT_FALSE(session->state().playing);
}

TEST(Session, ASingleStepIsFollowedByAPause) {
  const auto session = make();
  step(*session, 3);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  session->take();
  EXPECT_EQ(session->state().step, 3);
  EXPECT_FALSE(session->state().playing);
  EXPECT_EQ(session->take_reports().size(), 3u);
  EXPECT_TRUE(session->take_reports().empty());
}

TEST(Session, NeverWaitsForASlowStep) {
  const auto session = make({.step_ms = 250});
  session->play();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));  // the first step is under way
  const auto begin = Clock::now();
  for (int k = 0; k < 100; ++k) {
    session->post(event(InputEvent::Kind::grab, 1, {1, 1, 1}));
    session->set("gravity.y", -1);
    session->take();
    session->take_reports();
  }
  const std::chrono::duration<double> taken = Clock::now() - begin;
  EXPECT_LT(taken.count(), 0.15);
  EXPECT_TRUE(wait_for_step(*session, 2));
}

TEST(Session, IsNotFasterThanTheClock) {
  const auto session = make();
  const auto begin = Clock::now();
  session->play();
  ASSERT_TRUE(wait_for_step(*session, 20));
  const std::chrono::duration<double> taken = Clock::now() - begin;
  EXPECT_GT(taken.count(), 18 * 0.01);
  EXPECT_GT(session->state().steps_per_second, 1);
  EXPECT_LT(session->state().steps_per_second, 115);

  session->set_real_time(false);
  const std::int64_t before = session->state().step;
  ASSERT_TRUE(wait_for_step(*session, before + 2000));
}

TEST(Session, ReplaysToTheSameBits) {
  const auto session = make();
  step(*session, 2);
  session->post(event(InputEvent::Kind::grab, 1, {0.5, 1.5, 0.1}));
  step(*session, 2);
  session->post(event(InputEvent::Kind::move, 1, {0.7, 1.5, 0.1}));
  session->set("step.time_step", 0.005);
  step(*session, 3);
  session->post(event(InputEvent::Kind::release, 1, {}));
  step(*session, 2);
  session->stop();
  const Recording recording = session->recording();
  EXPECT_EQ(recording.steps.size(), 9u);
  EXPECT_EQ(recording.build, "cpu32");
  EXPECT_EQ(replay(recording), recording.final_hash);
}

TEST(Session, OnlyTheNewestTargetReachesAStep) {
  const auto session = make({.step_ms = 40});
  session->post(event(InputEvent::Kind::grab, 1, {0, 0, 0}));
  session->post(event(InputEvent::Kind::grab, 2, {0, 0, 0}));
  for (int k = 0; k < 50; ++k) {
    session->post(event(InputEvent::Kind::move, 1, {0.1 * k, 0, 0}));
    session->post(event(InputEvent::Kind::move, 2, {0.2 * k, 0, 0}));
  }
  step(*session);
  session->stop();
  const Recording recording = session->recording();
  const auto& events = recording.steps.at(0).events;
  ASSERT_EQ(events.size(), 2u);
  EXPECT_DOUBLE_EQ(events[0].target.x, 4.9);
  EXPECT_DOUBLE_EQ(events[1].target.x, 9.8);
}

TEST(Session, PausesOnARefusedStepAndGoesOnWithASmallerOne) {
  const auto session = make({.refuse = 2, .refuse_above = 0.006});
  session->set_real_time(false);
  session->play();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.failed; }));
  EXPECT_FALSE(session->state().playing);
  EXPECT_EQ(session->state().step, 2);
  EXPECT_EQ(session->state().report.offending.size(), 1u);
  EXPECT_NE(session->state().failure.find("3 collisions"), std::string::npos);
  session->set("step.time_step", 0.005);
  session->play();
  ASSERT_TRUE(wait_for_step(*session, 4));
  EXPECT_FALSE(session->state().failed);
  EXPECT_DOUBLE_EQ(session->state().parameters.step.time_step, 0.005);
  session->stop();
  EXPECT_EQ(replay(session->recording(), {.refuse = 2, .refuse_above = 0.006}),
            session->recording().final_hash);
}

TEST(Session, ShowsTheNotesOfAStepAsOne) {
  const auto session = make({.note = 0});
  session->step_once();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.notes == 1; }));
  EXPECT_EQ(session->state().note, "seam 'a': welded; seam 'b': stuck");
}

TEST(Session, PassesOverARefusedStepAndReplaysThat) {
  const FakeOptions options{.refuse = 2, .refuse_above = 0.006};
  const auto session = make(options);
  session->set_real_time(false);

  // Without a refused step there is nothing to pass over.
  session->pass_over();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.notes == 1; }));
  EXPECT_EQ(session->state().step, 0);

  session->play();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.failed; }));
  EXPECT_TRUE(session->state().may_pass_over);
  const double before = session->state().time;
  session->pass_over();
  ASSERT_TRUE(wait_for_step(*session, 3));
  EXPECT_FALSE(session->state().failed || session->state().may_pass_over);
  EXPECT_FALSE(session->state().playing);
  EXPECT_DOUBLE_EQ(session->state().time, before + 0.01);
  EXPECT_NE(session->state().note.find("went on to"), std::string::npos) << session->state().note;

  // It goes on from there, and a replay of the recording does the same.
  session->set("step.time_step", 0.005);
  step(*session, 2);
  session->stop();
  const Recording recording = session->recording();
  ASSERT_EQ(recording.steps.size(), 5u);
  EXPECT_TRUE(recording.steps[2].passed_over);
  EXPECT_EQ(replay(recording, options), recording.final_hash);
}

TEST(Session, NamesVerticesAsTheTerminalDoes) {
  // Vertex 2 of the file was welded to vertex 0, so that the numbers behind it move.
  Scene scene;
  scene.cloths.resize(1);
  Cloth& cloth = scene.cloths[0];
  cloth.name = "shirt";
  cloth.mesh.positions.resize(4);
  cloth.mesh.faces = {{0, 1, 2}, {1, 3, 2}};
  cloth.pins = {3};
  scene.obstacles.resize(1);
  scene.obstacles[0].name = "ball";
  scene.obstacles[0].mesh.positions.resize(3);
  scene.obstacles[0].mesh.faces.resize(1);
  FileLayout layout;
  layout.vertex = {0, 1, 0, 2, 3};
  StepReport report;
  report.accepted = false;
  report.offending = {{false, {3, 4, 5, 6}}};
  const std::vector<FileLayout> layouts{layout};
  const std::string text = failure_sentence(report, scene, ElementNames(scene, layouts), false);
  EXPECT_NE(text.find("obstacle:ball is pushed into the pinned vertices 4 of cloth:shirt"),
            std::string::npos)
      << text;
  EXPECT_NE(failure_sentence(report, scene, ElementNames(scene), true).find("--precision f64"),
            std::string::npos);
}

TEST(Session, RefusesToRunFromABadStartState) {
  SessionOptions options;
  options.refusal = "2 pairs of faces cross";
  const auto session = make({}, options);
  EXPECT_TRUE(session->state().failed);
  session->play();
  session->step_once();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  session->take();
  EXPECT_EQ(session->state().step, 0);
  EXPECT_EQ(session->state().failure, options.refusal);
}

TEST(Session, TellsWhenTheSolverThrows) {
  const auto session = make({.explode = 1});
  session->play();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.failed; }));
  EXPECT_NE(session->state().failure.find("out of order"), std::string::npos);
  EXPECT_FALSE(session->state().playing);
}

TEST(Session, SurvivesALostDevice) {
  const auto session = make({.lose = 3, .on_device = true});
  step(*session, 3);
  const auto positions = session->state().positions;
  session->play();
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.failed; }));
  EXPECT_EQ(session->state().failure, "The solver stopped: device lost");
  EXPECT_EQ(session->state().positions, positions) << "the last that were told";
  ASSERT_NE(session->state().on_device, nullptr);
  EXPECT_EQ(session->state().on_device->failure, "the solver stopped");
  session->step_back();
  session->reset();
  session->play();
  session->save("/nonexistent/folder/file.json");
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.notes >= 1; }));
  EXPECT_FALSE(session->state().playing);
  EXPECT_EQ(session->state().failure, "The solver stopped: device lost");
  EXPECT_EQ(session->state().positions, positions);
  session->stop();
}

TEST(Session, KeepsNoPositionsOnADeviceForASolverOnTheCpu) {
  const auto session = make();
  step(*session, 2);
  EXPECT_EQ(session->state().on_device, nullptr);
}

/// The state that is looked at stays whole, on the device too, while the solver goes on.
TEST(Session, EverySlotHasPositionsOfItsOwnOnTheDevice) {
  const auto session = make({.vertices = 300, .on_device = true});
  session->set_real_time(false);
  session->play();
  std::vector<const Vec3f*> memories;
  std::int64_t step = 0;
  for (int k = 0; k < 40; ++k) {
    ASSERT_TRUE(wait_for_step(*session, step + 1));
    const PublishedState& state = session->state();
    step = state.step;
    ASSERT_NE(state.on_device, nullptr);
    ASSERT_EQ(state.on_device->count, 300);
    if (std::ranges::find(memories, state.on_device->data) == memories.end())
      memories.push_back(state.on_device->data);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the solver publishes meanwhile
    for (std::size_t v = 0; v < 300; ++v) ASSERT_EQ(state.on_device->data[v], state.positions[v]);
  }
  EXPECT_LE(memories.size(), 3u) << "the memory of a slot is used again";
  EXPECT_GE(memories.size(), 2u);
}

TEST(Session, PlaysTheGrabsOfTheSceneOnlyWhenAsked) {
  auto simulator = std::make_unique<FakeSimulator>();
  ScriptedGrab grab;
  grab.release = 10;
  grab.path = {{0, {0, 2, 0}}};
  simulator->scene_for_setup().input.push_back(grab);
  Session session(std::move(simulator), {});
  step(session, 2);
  EXPECT_TRUE(session.state().handles.empty());
  session.set_scripted(true);
  step(session);
  ASSERT_EQ(session.state().handles.size(), 1u);
  EXPECT_EQ(session.state().handles[0].id, kFirstScriptedHandle);
  session.set_scripted(false);
  step(session);
  EXPECT_TRUE(session.state().handles.empty());
}

TEST(Session, SavesAStateAndSaysSo) {
  const auto session = make();
  step(*session, 2);
  const std::string path = ::testing::TempDir() + "session_test.json";
  session->save(path);
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.notes == 1; }));
  EXPECT_NE(session->state().note.find(path), std::string::npos);
  EXPECT_EQ(load_recording(path).steps.size(), 2u);
  std::remove(path.c_str());
  session->save("/nonexistent/folder/file.json");
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.notes == 2; }));
  EXPECT_NE(session->state().note.find("not saved"), std::string::npos);
}

TEST(Session, RefusesValuesOutOfRangeWithANote) {
  const auto session = make();
  session->set("step.time_step", 50);
  ASSERT_TRUE(wait_until(*session, [](const auto& s) { return s.notes == 1; }));
  EXPECT_NE(session->state().note.find("step.time_step"), std::string::npos);
  EXPECT_DOUBLE_EQ(session->state().parameters.step.time_step, 0.01);
}

}  // namespace
}  // namespace icloth
