// The session: nothing waits for the solver, and what was done can be done again.
#include "app/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "tests/support/fake_simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using testing::FakeOptions;
using testing::FakeSimulator;
using Clock = std::chrono::steady_clock;

/// Looks at the session as the window does until the condition holds; false after 5 s.
bool wait_until(Session& session, const std::function<bool(const PublishedState&)>& condition) {
  const auto end = Clock::now() + std::chrono::seconds(5);
  while (Clock::now() < end) {
    session.take();
    if (condition(session.state())) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

bool wait_for_step(Session& session, std::int64_t step) {
  return wait_until(session, [=](const PublishedState& s) { return s.step >= step; });
}

/// Runs single steps and waits for each.
void step(Session& session, int count = 1) {
  for (int k = 0; k < count; ++k) {
    const std::int64_t next = session.state().step + 1;
    session.step_once();
    ASSERT_TRUE(wait_for_step(session, next));
  }
}

InputEvent event(InputEvent::Kind kind, int handle, Vec3d target) {
  InputEvent e;
  e.kind = kind;
  e.handle = handle;
  e.target = target;
  return e;
}

/// Runs a recording as `icloth replay` does, and returns the hash of the state at the end.
std::uint64_t replay(const Recording& recording, Simulator& simulator) {
  for (const Recording::Step& s : recording.steps) {
    Parameters parameters = simulator.parameters();
    for (const auto& [name, value] : s.parameters) {
      set_parameter(parameters, *find_parameter(name), value);
    }
    if (!s.parameters.empty()) simulator.set_parameters(parameters);
    const bool accepted = simulator.step(s.events).accepted;
    if (!accepted && s.passed_over) simulator.pass_over();
  }
  return simulator.state_hash();
}

std::uint64_t replay(const Recording& recording, FakeOptions options = {}) {
  FakeSimulator simulator(options);
  return replay(recording, simulator);
}

std::unique_ptr<Session> make(FakeOptions options = {}, SessionOptions session = {}) {
  session.scene = "fake";
  return std::make_unique<Session>(std::make_unique<FakeSimulator>(options), session);
}

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

TEST(Session, GoesBackAndOnFromThere) {
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

TEST(Session, HoldsParkedHandlesThroughAStepBack) {
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

TEST(Session, ResetsAndKeepsTheParameters) {
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

TEST(Session, ReachesAllStatesInBoundedMemory) {
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

TEST(Session, ShowsOlderStatesWithoutGoingThere) {
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

TEST(Session, ReturnsToTheRunThatWasLeft) {
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

TEST(Session, StopsMakingStepsAgainWhenSomethingIsAskedFor) {
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

TEST(Session, GoingBackUndoesThatAStepWasPassedOver) {
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

// ---- with a real solver ------------------------------------------------------------------------

/// Two sheets that start closer than the thickness, over a ball, and a hand of the scene's own.
std::shared_ptr<const Scene> real_scene() {
  auto scene = std::make_shared<Scene>();
  scene->name = "test";
  scene->cloths.push_back(testing::make_sheet(testing::lying(0.3, 120), {0.01, 0.112, 0.02}));
  scene->cloths.push_back(testing::make_sheet(testing::lying(0.3, 120), {0, 0.1123, 0}));
  scene->obstacles.push_back(testing::make_obstacle(make_sphere(0.1, 320), {}));
  scene->parameters.implicit.integrator = Integrator::bdf2;
  ScriptedGrab grab;
  grab.vertex = 3;
  grab.release = 10;
  grab.path = {{0, {0.1, 0.2, 0}}, {1, {0.3, 0.4, 0.1}}};
  scene->input.push_back(grab);
  return scene;
}

std::unique_ptr<Session> make_real() {
  return std::make_unique<Session>(make_simulator(Build::cpu32, real_scene()), SessionOptions{});
}

std::uint64_t replay_with_real(const Recording& recording) {
  const auto simulator = make_simulator(Build::cpu32, real_scene());
  return replay(recording, *simulator);
}

InputEvent grab_of_face(int handle, Index face, Vec3d target) {
  InputEvent grab = event(InputEvent::Kind::grab, handle, target);
  grab.face = face;
  return grab;
}

void go_back(Session& session, std::size_t count) {
  const std::uint64_t rewinds = session.state().rewinds + 1;
  session.step_back(count);
  ASSERT_TRUE(wait_until(session, [=](const auto& s) { return s.rewinds == rewinds; }));
}

TEST(Session, ReplaysToTheSameBitsAfterGoingBackWithHands) {
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
TEST(Session, TheSameStepsAfterGoingBackEndInTheSameState) {
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

TEST(Session, SettingsTriedBetweenTwoStepsLeaveNoTrace) {
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

TEST(Session, ReplaysToTheSameBitsWhenSettingsChangedBeforeGoingBack) {
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

TEST(Session, ReplaysToTheSameBitsAfterReset) {
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
