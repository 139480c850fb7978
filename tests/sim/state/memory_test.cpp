// A snapshot has everything that a step goes on from, and it survives as bytes.
#include "sim/state/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

using Bytes = std::vector<std::byte>;
using testing::lying;
using testing::make_obstacle;
using testing::make_sheet;

constexpr std::size_t kHead = 20, kTail = 8;  // of the bytes, around the payload

// ---- a memory as bytes -------------------------------------------------------------------------

/// Something in every part, all values different.
Snapshot full_snapshot() {
  double next = 0.5;
  const auto number = [&next] { return next += 1.25; };
  const auto vector = [&] { return Vec3d{number(), number(), number()}; };
  Snapshot s;
  s.step = 12;
  s.time = 0.12;
  s.body_lag = 0.03;
  for (int k = 0; k < 4; ++k) s.x1.push_back(vector()), s.v.push_back(vector());
  s.held = {{7, vector(), 1}, {1u << 31, vector(), 0}};
  for (int k = 0; k < 3; ++k) {
    s.past.motion.push_back(vector()), s.past.change.push_back(vector());
    s.start_gap.push_back(number()), s.still_x.push_back(vector());
  }
  s.still_since = 0.07;
  s.past.dt = 0.01;
  s.yarns = {{{number(), number(), number()}, number()}};
  s.yarns_bend = true;
  for (int k = 0; k < 4; ++k)
    s.trusted_start.push_back({{1, 2, 3}, {4, 5, 6.5F + static_cast<float>(k)}});
  s.trusted_end = s.trusted_start;
  s.trusted_end[3].lo[0] = 0.5F;
  s.trusted_complete = true;

  s.stitches = {{number(), number(), 3}, {-1, number(), 0}};
  s.seams = {{1, 20, 33}};
  s.let_go = {{1, 2, 1}, {2, 2, -1}};

  HeldPatch hand;
  hand.id = 3, hand.radius = number(), hand.stiffness = number(), hand.target = vector();
  hand.barycentric = vector(), hand.followed = vector(), hand.pulled_to = vector();
  hand.saturation = number();
  hand.corners = {0, 2, 1};
  hand.vertices = {0, 2}, hand.share = {0.25, 0.75}, hand.offset = {vector(), vector()};
  s.hands = {hand, hand};
  s.hands[1].id = 1001;
  s.hands[1].vertices.clear(), s.hands[1].share.clear(), s.hands[1].offset.clear();
  return s;
}

constexpr MemoryShape kFullShape{4, 3, 1, 3, 2, 1};

template <class T>
void put(Bytes& bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

/// Makes the check sum right again, as someone would who wants to be read (FNV-1a).
void sign(Bytes& bytes) {
  std::uint64_t sum = 14695981039346656037u;
  for (std::size_t i = kHead; i + kTail < bytes.size(); ++i)
    sum = (sum ^ static_cast<std::uint64_t>(bytes[i])) * 1099511628211u;
  put(bytes, bytes.size() - kTail, sum);
}

/// Text of the refusal; empty when the bytes are taken. Nothing but an InputError may be thrown.
std::string refusal(const Bytes& bytes) {
  try {
    memory_from_bytes(bytes, "file.icloth");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Memory, SurvivesAsBytesInEveryPart) {
  const Snapshot full = full_snapshot();
  const Bytes bytes = memory_to_bytes(full);
  const Snapshot again = memory_from_bytes(bytes, "bytes");
  EXPECT_EQ(memory_to_bytes(again), bytes);
  check_memory(again, kFullShape);

  EXPECT_EQ(again.step, 12);
  EXPECT_EQ(again.x1, full.x1);
  EXPECT_EQ(again.v, full.v);
  EXPECT_EQ(again.held[1].key, full.held[1].key);
  EXPECT_EQ(again.past.change, full.past.change);
  EXPECT_EQ(again.yarns[0].shear, full.yarns[0].shear);
  EXPECT_TRUE(again.yarns_bend);
  EXPECT_EQ(again.start_gap, full.start_gap);
  EXPECT_EQ(again.trusted_start[3].hi[2], 9.5F);
  EXPECT_EQ(again.trusted_end[3].lo[0], 0.5F);
  ASSERT_EQ(again.stitches.size(), 2u);
  EXPECT_EQ(again.stitches[0].mark, full.stitches[0].mark);
  EXPECT_EQ(again.seams.at(0).next, 33);
  ASSERT_EQ(again.let_go.size(), 2u);
  EXPECT_EQ(again.let_go[1].side, -1);
  ASSERT_EQ(again.hands.size(), 2u);
  EXPECT_EQ(again.hands[0].share, full.hands[0].share);
  EXPECT_EQ(again.hands[0].offset, full.hands[0].offset);
  EXPECT_EQ(again.hands[1].id, 1001);
}

TEST(Memory, EveryPartIsInTheBytes) {
  const Bytes bytes = memory_to_bytes(full_snapshot());
  const Snapshot empty;
  int parts = 0;
  for_each_part([&](const MemoryPart&, const auto&) { ++parts; }, empty);
  // A memory in which one part alone is replaced by the empty one gives other bytes.
  for (int part = 0; part < parts; ++part) {
    Snapshot other = full_snapshot();
    int k = 0;
    const auto replace = [&](const MemoryPart&, auto& to, const auto& from) {
      if (k++ == part) to = from;
    };
    for_each_part(replace, other, empty);
    EXPECT_NE(memory_to_bytes(other), bytes) << part;
  }
}

TEST(Memory, RefusesBytesThatWereCutOrHaveMoreAtTheirEnd) {
  const Bytes bytes = memory_to_bytes(full_snapshot());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(refusal(cut), "") << size;
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_NE(refusal(longer).find("file.icloth: memory: "), std::string::npos) << refusal(longer);
}

TEST(Memory, RefusesEveryAlteredByte) {
  const Bytes bytes = memory_to_bytes(full_snapshot());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes altered = bytes;
    altered[i] ^= std::byte{0x10};
    EXPECT_NE(refusal(altered), "") << i;
  }
}

/// A signed count of anything must neither take memory for it nor be believed.
TEST(Memory, RefusesAlteredLengthsThatAreSignedAsWell) {
  const Bytes bytes = memory_to_bytes(full_snapshot());
  constexpr std::size_t kFirstCount = kHead + 24;  // of x1, after step, time and lag
  for (const std::uint64_t count : {0ull, 3ull, 5ull, 8ull, 1ull << 40, ~0ull}) {
    Bytes altered = bytes;
    put(altered, kFirstCount, count);
    sign(altered);
    EXPECT_NE(refusal(altered), "") << count;
  }
  Bytes altered = bytes;
  put(altered, kFirstCount, std::uint64_t{1} << 61);
  sign(altered);
  EXPECT_NE(refusal(altered).find("x1: 2305843009213693952 elements, expected at most "),
            std::string::npos)
      << refusal(altered);

  // Wherever a large number stands, it is a value or it is refused.
  for (std::size_t offset = kHead; offset + kTail + 8 <= bytes.size(); ++offset) {
    altered = bytes;
    put(altered, offset, std::uint64_t{1} << 60);
    sign(altered);
    refusal(altered);
  }
}

TEST(Memory, RefusesOtherFilesAndVersions) {
  Bytes other = memory_to_bytes(full_snapshot());
  other[0] = std::byte{'X'};
  EXPECT_NE(refusal(other).find("ICLOTHME"), std::string::npos);
  other = memory_to_bytes(full_snapshot());
  put(other, 8, std::uint32_t{1});
  EXPECT_NE(refusal(other).find("version 1, expected 6"), std::string::npos);
}

TEST(Memory, CountsTheBytesOfItsLists) {
  Snapshot s;
  const std::size_t empty = memory_bytes(s);
  s.x1.resize(10);
  s.x1.shrink_to_fit();
  EXPECT_EQ(memory_bytes(s), empty + 10 * sizeof(Vec3d));
}

// ---- a memory against a scene ------------------------------------------------------------------

std::string misfit(const std::function<void(Snapshot&)>& change) {
  Snapshot s = full_snapshot();
  change(s);
  try {
    check_memory(s, kFullShape);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(Memory, OfAnotherSceneIsRefusedByPartAndCount) {
  EXPECT_EQ(misfit([](Snapshot&) {}), "");
  EXPECT_EQ(misfit([](Snapshot& s) { s.x1.pop_back(); }),
            "snapshot of another scene: x1: 3 elements, expected 4");
  EXPECT_EQ(misfit([](Snapshot& s) { s.v.clear(); }),
            "snapshot of another scene: v: 0 elements, expected 4");
  EXPECT_EQ(misfit([](Snapshot& s) { s.yarns.resize(2); }),
            "snapshot of another scene: yarns: 2 elements, expected 1 or none");
  EXPECT_EQ(misfit([](Snapshot& s) { s.let_go[0].vertex = 3; }),
            "snapshot of another scene: let_go: vertex 3, expected 0 to 2");
  EXPECT_EQ(misfit([](Snapshot& s) { s.let_go[0].body = -1; }),
            "snapshot of another scene: let_go: body -1, expected 0 to 2");
  EXPECT_EQ(misfit([](Snapshot& s) { s.let_go[1].side = 0; }),
            "snapshot of another scene: let_go: side 0, expected 1 or -1");
  EXPECT_NE(misfit([](Snapshot& s) { s.start_gap.resize(1); }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.trusted_start.resize(1); }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.trusted_end.resize(1); }), "");
  EXPECT_EQ(misfit([](Snapshot& s) { s.stitches.pop_back(); }),
            "snapshot of another scene: stitches: 1 elements, expected 2");
  EXPECT_NE(misfit([](Snapshot& s) { s.seams.clear(); }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.past.motion.clear(); }), "");
  EXPECT_EQ(misfit([](Snapshot& s) { s.past.forget(); }), "");
  EXPECT_EQ(misfit([](Snapshot& s) { s.held.clear(); }), "");
}

TEST(Memory, OfHandsThatHoldWhatIsNotThereIsRefused) {
  EXPECT_EQ(misfit([](Snapshot& s) { s.hands[0].vertices[1] = 3; }),
            "snapshot of another scene: hand 3: vertex 3, expected 0 to 2");
  EXPECT_NE(misfit([](Snapshot& s) { s.hands[0].vertices[0] = -1; }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.hands[1].corners[2] = 3; }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.hands[1].face = 1; }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.hands[0].share.pop_back(); }), "");
  EXPECT_NE(misfit([](Snapshot& s) { s.hands[0].offset.pop_back(); }), "");
}

// ---- steps that go on from a memory ------------------------------------------------------------

/// Two hands that grab, move and let go, of the cloths' first and last face.
std::vector<InputEvent> hand_events(const Simulator& simulator, int step) {
  std::vector<InputEvent> events;
  const Scene& scene = simulator.scene();
  Index faces = 0;
  for (const Cloth& cloth : scene.cloths) faces += static_cast<Index>(cloth.mesh.faces.size());
  const Vec3d start = scene.cloths[0].mesh.positions[0];
  const auto add = [&](InputEvent::Kind kind, int handle, Index face, Vec3d target) {
    InputEvent event;
    event.kind = kind, event.handle = handle, event.face = face, event.target = target;
    event.barycentric = {0.25, 0.25, 0.5};
    event.radius = handle == 1 ? 0 : 0.07;
    events.push_back(event);
  };
  const double t = 0.01 * step;
  if (step == 2) add(InputEvent::Kind::grab, 1, 0, start + Vec3d{0.02, 0.05, 0.1});
  if (step == 9) add(InputEvent::Kind::grab, 2, faces - 1, start + Vec3d{0.1, 0.1, -0.1});
  if (step > 2 && step < 45 && step % 3 == 0)
    add(InputEvent::Kind::move, 1, 0, start + Vec3d{0.1 * t, 0.05 + 0.3 * t, 0.1});
  if (step == 45) add(InputEvent::Kind::release, 1, 0, {});
  if (step == 52) add(InputEvent::Kind::grab, 1, 1, start + Vec3d{0, 0.1, 0});
  return events;
}

/// A run that is remembered in whole: the state before each step, and what the step gave.
struct RememberedRun {
  std::vector<Snapshot> before;
  std::vector<std::vector<InputEvent>> events;
  std::vector<StepReport> reports;

  RememberedRun(Simulator& simulator, int steps) {
    ScriptedInput script(simulator.scene());
    for (int k = 0; k < steps; ++k) {
      before.push_back(simulator.snapshot());
      events.push_back(hand_events(simulator, k));
      for (const InputEvent& event :
           script.events(simulator.time(), simulator.parameters().step.time_step))
        events.back().push_back(event);
      reports.push_back(simulator.step(events.back()));
    }
    before.push_back(simulator.snapshot());
  }

  /// `fresh` goes on for a number of steps from the state before step `first`, with equal reports
  /// and in the end an equal memory.
  void expect_the_same_from(int first, int steps, Simulator& fresh) const {
    SCOPED_TRACE(first);
    fresh.restore(memory_from_bytes(memory_to_bytes(before[at(first)]), "bytes"));
    for (int k = first; k < first + steps; ++k) {
      const StepReport now = fresh.step(events[at(k)]);
      ASSERT_EQ(now.state_hash, reports[at(k)].state_hash) << "step " << k;
      ASSERT_EQ(now.accepted, reports[at(k)].accepted) << "step " << k;
      ASSERT_EQ(now.energy_balance, reports[at(k)].energy_balance) << "step " << k;
      ASSERT_EQ(now.proximity_pairs, reports[at(k)].proximity_pairs) << "step " << k;
    }
    ASSERT_EQ(memory_to_bytes(fresh.snapshot()), memory_to_bytes(before[at(first + steps)]));
  }
};

struct Case {
  std::string scene;
  Build build;
};

class BuiltInScenes : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    std::string reason;
    if (!build_available(GetParam().build, &reason)) GTEST_SKIP() << reason;
  }
  static std::unique_ptr<Simulator> make(std::vector<std::string> overrides) {
    return make_simulator(GetParam().build, load_scene(GetParam().scene, overrides));
  }
};

std::vector<Case> cases() {
  std::vector<Case> list;
  for (const char* scene : {"scarf", "sphere", "twisting", "funnel", "drape", "flag"})
    for (const Build build : {Build::cpu32, Build::cuda32}) list.push_back({scene, build});
  list.push_back({"drape", Build::cpu64});
  return list;
}

INSTANTIATE_TEST_SUITE_P(Memory, BuiltInScenes, ::testing::ValuesIn(cases()),
                         [](const auto& instance) {
                           return instance.param.scene + "_" +
                                  std::string(build_name(instance.param.build));
                         });

TEST_P(BuiltInScenes, GoOnInAFreshSimulatorFromEveryStep) {
  constexpr int kSteps = 60, kOn = 5;
  // Double precision runs with the integrator that has no past.
  const bool two_steps = GetParam().build != Build::cpu64;
  const std::string integrator = two_steps ? "bdf2" : "backward_euler";
  const auto simulator = make({"triangles=200", "implicit.integrator=" + integrator});
  const RememberedRun run(*simulator, kSteps + kOn);

  // The run must have had everything that is to be remembered.
  const auto any = [&](const auto& condition) {
    return std::ranges::any_of(run.before, condition);
  };
  EXPECT_TRUE(any([](const Snapshot& s) { return s.hands.size() >= 2; }));
  EXPECT_TRUE(any([](const Snapshot& s) { return !s.trusted_end.empty() && s.trusted_complete; }));
  EXPECT_TRUE(GetParam().scene == "flag" || GetParam().scene == "funnel" ||
              any([](const Snapshot& s) { return !s.held.empty(); }));
  EXPECT_EQ(any([](const Snapshot& s) { return !s.yarns.empty(); }), GetParam().scene == "drape");
  EXPECT_EQ(any([](const Snapshot& s) { return s.past.dt > 0; }), two_steps);

  const auto scene = std::make_shared<const Scene>(simulator->scene());
  for (int k = 1; k <= kSteps; ++k) {
    const auto fresh = make_simulator(GetParam().build, scene);
    run.expect_the_same_from(k, kOn, *fresh);
    if (HasFatalFailure()) return;
  }
}

/// Takes minutes, so it runs only where it is asked for (--gtest_also_run_disabled_tests).
TEST_P(BuiltInScenes, DISABLED_GoOnInAFreshSimulatorAtFullSize) {
  const auto simulator = make({});
  const RememberedRun run(*simulator, 120);
  for (const int k : {1, 5, 19, 21, 100}) {
    const auto fresh = make({});
    run.expect_the_same_from(k, 20, *fresh);
    if (HasFatalFailure()) return;
  }
}

class Builds : public ::testing::TestWithParam<Build> {
 protected:
  void SetUp() override {
    std::string reason;
    if (!build_available(GetParam(), &reason)) GTEST_SKIP() << reason;
  }
};

INSTANTIATE_TEST_SUITE_P(Memory, Builds,
                         ::testing::Values(Build::cpu32, Build::cpu64, Build::cuda32),
                         [](const auto& instance) {
                           return std::string(build_name(instance.param));
                         });

/// Two sheets closer than the thickness, whose repulsion grows during the first 0.2 s.
std::shared_ptr<const Scene> close_layers() {
  auto scene = std::make_shared<Scene>();
  scene->name = "close layers";
  scene->cloths.push_back(make_sheet(lying(0.2, 100), {0, 0.0520, 0}));
  scene->cloths.push_back(make_sheet(lying(0.2, 100), {0.003, 0.0523, 0.004}));
  scene->obstacles.push_back(make_obstacle(make_box({0.3, 0.1, 0.3}, 0.1), {}));
  return scene;
}

TEST_P(Builds, LayersThatStartCloseRememberHowClose) {
  const auto simulator = make_simulator(GetParam(), close_layers());
  const RememberedRun run(*simulator, 30);
  EXPECT_FALSE(run.before[5].start_gap.empty());
  EXPECT_TRUE(run.before[25].start_gap.empty()) << "it is not used any more";
  for (const int k : {1, 5, 15, 19, 20, 21, 25}) {
    const auto fresh = make_simulator(GetParam(), close_layers());
    run.expect_the_same_from(k, 5, *fresh);
  }
  // Without the gaps the sheets are thrown apart, so the test above can fail.
  Snapshot without = run.before[5];
  without.start_gap.clear();
  const auto fresh = make_simulator(GetParam(), close_layers());
  fresh->restore(without);
  EXPECT_NE(fresh->step(run.events[5]).state_hash, run.reports[5].state_hash);
}

TEST_P(Builds, ARefusedStepLeavesTheMemoryAsItWas) {
  const auto simulator = make_simulator(GetParam(), close_layers());
  for (int k = 0; k < 6; ++k) simulator->step(hand_events(*simulator, k));
  const Parameters sane = simulator->parameters();
  Parameters wrong = sane;
  wrong.gravity.y = std::numeric_limits<double>::quiet_NaN();
  simulator->set_parameters(wrong);
  Snapshot before = simulator->snapshot();
  EXPECT_FALSE(simulator->step({}).accepted);

  // But for the hands, which go on towards their targets.
  Snapshot after = simulator->snapshot();
  ASSERT_EQ(after.hands.size(), 1u);
  before.hands.clear(), after.hands.clear();
  EXPECT_EQ(memory_to_bytes(after), memory_to_bytes(before));
  simulator->set_parameters(sane);
  EXPECT_TRUE(simulator->step({}).accepted);
}

TEST_P(Builds, ARestoredSimulatorHasForgottenItsOwnPast) {
  const auto simulator = make_simulator(GetParam(), close_layers());
  const RememberedRun run(*simulator, 15);
  const auto other = make_simulator(GetParam(), close_layers());
  for (int k = 0; k < 40; ++k) other->step({});  // elsewhere, without hands
  run.expect_the_same_from(8, 5, *other);
  run.expect_the_same_from(0, 5, *other);
}

}  // namespace
}  // namespace icloth
