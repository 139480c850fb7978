// Open seams: the springs, how sheets close and are welded, and what the scene file says.
#include <gtest/gtest.h>

#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double
#include "kernels/index.h"
#include "kernels/seam_spring.h"
#include "sim/files/error.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/scene_meshes.h"
#include "sim/sewing_simulator.h"
#include "tests/support/sewn_sheets.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

using testing::border;
using testing::hanging;
using testing::kSheetSize;
using testing::make_obstacle;
using testing::make_sheet;
using testing::two_sheets;

// ---- the spring --------------------------------------------------------------------------------

TEST(SeamSpring, ForceIsMinusTheGradientOfTheEnergy) {
  const double k = 3, step = 1e-6;
  const Vec3d a{0.1, -0.2, 0.3}, b{-0.05, 0.1, 0.2};
  const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3d axis : axes) {
    const double slope =
        (cpu64::seam_energy(k, a + step * axis, b) - cpu64::seam_energy(k, a - step * axis, b)) /
        (2 * step);
    EXPECT_NEAR(dot(cpu64::seam_force(k, a, b), axis), -slope, 1e-8);

    // The derivative of the force on a is −k by a and k by b.
    const Vec3d by_a =
        (1 / step) * (cpu64::seam_force(k, a + step * axis, b) - cpu64::seam_force(k, a, b));
    const Vec3d by_b =
        (1 / step) * (cpu64::seam_force(k, a, b + step * axis) - cpu64::seam_force(k, a, b));
    EXPECT_NEAR(norm(by_a + k * axis), 0, 1e-8);
    EXPECT_NEAR(norm(by_b - k * axis), 0, 1e-8);
  }
}

TEST(SeamSpring, GrowsUntilItPullsAsHardAsItMay) {
  const cpu64::SeamLaw law{0.3, 0.02, 0.5, 0.5, 2e-4};
  EXPECT_DOUBLE_EQ(cpu64::closing_time(law, 0), 0.3);
  EXPECT_NEAR(cpu64::closing_time(law, 0.25), std::sqrt(0.3 * 0.02), 1e-12);
  EXPECT_NEAR(cpu64::closing_time(law, 0.5), 0.02, 1e-12);
  EXPECT_NEAR(cpu64::closing_time(law, 1), 0.02 * 0.02 / 0.3, 1e-12);

  // At any time the pull is m (2/τ)² r, at most 0.5 N, and the stiffness at most 0.5 N in ε / 2.
  const double mass = 1e-3;
  EXPECT_NEAR(cpu64::seam_stiffness(law, 0.5, mass, 1e-4), mass * 1e4, 1e-9);
  for (const double distance : {0.06, 0.5, 3.0})
    EXPECT_NEAR(cpu64::seam_stiffness(law, 1, mass, distance) * distance, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(cpu64::seam_stiffness(law, 1e9, mass, 1e-5), 5000);

  // An open pair is pulled fully when its force is the largest.
  EXPECT_FALSE(cpu64::pulls_fully(law, 0, mass, 0.06));
  EXPECT_TRUE(cpu64::pulls_fully(law, 1, mass, 0.06));
  EXPECT_TRUE(cpu64::pulls_fully(law, 1e9, mass, 3e-4));
}

// ---- two sheets side by side -------------------------------------------------------------------

std::size_t intersections(const Simulator& simulator) {
  const SceneFaces soup = scene_faces(simulator.sewn_scene());
  return find_intersections(simulator.snapshot().x1, soup.faces, soup.group).size();
}

bool has_note(const StepReport& report, const std::string& part) {
  return std::ranges::any_of(
      report.notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

/// Steps until the seam is welded; each accepted, none with an intersection.
int steps_to_weld(Simulator& simulator, int most, ScriptedInput* script = nullptr) {
  for (int k = 1; k <= most; ++k) {
    std::vector<InputEvent> events;
    if (script) events = script->events(simulator.time(), 0.01);
    const StepReport report = simulator.step(events);
    EXPECT_TRUE(report.accepted) << k;
    EXPECT_EQ(intersections(simulator), 0u) << k;
    if (has_note(report, "welded")) return k;
  }
  return 0;
}

class SeamBuilds : public ::testing::TestWithParam<Build> {
 protected:
  void SetUp() override {
    std::string reason;
    if (!build_available(GetParam(), &reason)) GTEST_SKIP() << reason;
  }
};
INSTANTIATE_TEST_SUITE_P(Seams, SeamBuilds,
                         ::testing::Values(Build::cpu32, Build::cpu64, Build::cuda32),
                         [](const auto& instance) {
                           return std::string(build_name(instance.param));
                         });

TEST_P(SeamBuilds, KeepTheMomentumOfFreeCloth) {
  const auto scene = two_sheets(0.03);
  const auto simulator = make_simulator(GetParam(), scene);
  const World world = make_world(*scene);
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(simulator->step({}).accepted);
  const Snapshot state = simulator->snapshot();
  Vec3d momentum;
  double size = 0;
  for (std::size_t v = 0; v < world.mass.size(); ++v) {
    momentum += world.mass[v] * state.v[v];
    size += world.mass[v] * norm(state.v[v]);
  }
  EXPECT_GT(size, 1e-6);
  EXPECT_LT(norm(momentum), 1e-3 * size);
}

TEST_P(SeamBuilds, CloseTwoSheetsAndWeldThem) {
  const auto scene = two_sheets(0.03);
  const auto simulator = make_simulator(GetParam(), scene);
  const World before = make_world(*scene);
  const int welded = steps_to_weld(*simulator, 300);
  ASSERT_GT(welded, 0);

  // A row of vertices and of edges is gone, and the faces are the same.
  const World after = make_world(simulator->sewn_scene());
  const auto pairs = static_cast<Index>(scene->seams[0].pairs.size());
  EXPECT_EQ(after.cloth_vertices, before.cloth_vertices - pairs);
  EXPECT_EQ(after.cloth_edges, before.cloth_edges - (pairs - 1));
  EXPECT_EQ(after.cloth_faces, before.cloth_faces);
  for (std::size_t f = 0; f < after.face_area.size(); ++f)
    ASSERT_NEAR(after.face_area[f], before.face_area[f], 1e-9 * before.face_area[f]);

  // Users see the vertices that the scene has, and the seam closed.
  std::vector<Vec3f> x;
  simulator->positions(x);
  ASSERT_EQ(x.size(), at(before.vertices));
  for (const auto& [a, b] : scene->seams[0].pairs) EXPECT_EQ(x[at(a)], x[at(b)]);
  for (int k = 0; k < 20; ++k) {
    const StepReport report = simulator->step({});
    ASSERT_TRUE(report.accepted) << k;
    ASSERT_EQ(report.open_pairs, 0);
    ASSERT_LT(report.max_strain, 0.1) << k;
    ASSERT_EQ(intersections(*simulator), 0u) << k;
  }
}

TEST_P(SeamBuilds, MakeNoEnergy) {
  const auto simulator = make_simulator(GetParam(), two_sheets(0.03));
  double kinetic = 0;
  for (int k = 0; k < 30; ++k) {
    const StepReport report = simulator->step({});
    kinetic = std::max(kinetic, report.kinetic_energy);
    EXPECT_LT(report.energy_balance, 1e-2 * kinetic + 1e-9) << k;
  }
  EXPECT_GT(kinetic, 1e-7);
}

TEST_P(SeamBuilds, CountInTheEnergyBalanceWhatAWeldChanges) {
  const auto simulator = make_simulator(GetParam(), two_sheets(0.03));
  Snapshot before;
  StepReport welded;
  for (int k = 0; k < 300 && !has_note(welded, "welded"); ++k) {
    before = simulator->snapshot();
    welded = simulator->step({});
  }
  ASSERT_TRUE(has_note(welded, "welded"));

  // The same step without the weld, which is put off.
  before.seams[0].next = 1'000'000;
  simulator->restore(before);
  const StepReport open = simulator->step({});
  ASSERT_FALSE(has_note(open, "welded"));
  const auto energy = [](const StepReport& r) {
    return r.kinetic_energy + r.elastic_energy + r.gravity_energy;
  };
  EXPECT_NE(energy(welded), energy(open));
  EXPECT_NEAR(welded.energy_balance - open.energy_balance, energy(welded) - energy(open),
              1e-9 * energy(open));
  EXPECT_LT(welded.kinetic_energy, open.kinetic_energy);
}

TEST(Seams, GoOnFromASnapshotWithTheSameBits) {
  const auto scene = two_sheets(0.02);
  const auto simulator = make_simulator(Build::cpu32, scene);
  std::vector<Snapshot> before;
  std::vector<std::uint64_t> hashes;
  int welded = -1;
  for (int k = 0; k < 200 && (welded < 0 || k < welded + 10); ++k) {
    before.push_back(memory_from_bytes(memory_to_bytes(simulator->snapshot()), "bytes"));
    const StepReport report = simulator->step({});
    hashes.push_back(report.state_hash);
    if (has_note(report, "welded")) welded = k;
  }
  ASSERT_GT(welded, 5);

  // A fresh simulator goes on from before the weld, over it, and from after it; the old one goes
  // back to a state with an open seam.
  const auto fresh = make_simulator(Build::cpu32, scene);
  for (Simulator* other : {fresh.get(), simulator.get()})
    for (const int first : {5, welded - 1, welded + 3, 2}) {
      other->restore(before[at(first)]);
      for (int k = first; k < std::min(first + 6, static_cast<int>(hashes.size())); ++k)
        ASSERT_EQ(other->step({}).state_hash, hashes[at(k)]) << first << " " << k;
    }
}

TEST(Seams, GiveTheSameBitsWithAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const auto simulator = make_simulator(Build::cpu32, two_sheets(0.02));
    for (int k = 0; k < 120; ++k) hashes[threads - 1].push_back(simulator->step({}).state_hash);
  }
  set_thread_count(0);
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Seams, ThatWaitForAHandAreLeftAlone) {
  const auto simulator = make_simulator(Build::cpu32, two_sheets(0.06, false));
  for (int k = 0; k < 20; ++k) simulator->step({});
  EXPECT_NEAR(simulator->step({}).seam_gap, 0.06, 1e-6);
}

/// Runs a scene file with its scripted hands; every step is accepted and none intersects.
struct ScriptedRun {
  explicit ScriptedRun(const std::string& file, int steps) {
    scene = load_scene(std::string(ICLOTH_TEST_FOLDER) + "/data/" + file, {});
    simulator = make_simulator(Build::cpu32, scene);
    ScriptedInput script(*scene);
    for (int k = 0; k < steps; ++k) {
      last = simulator->step(script.events(simulator->time(), scene->parameters.step.time_step));
      EXPECT_TRUE(last.accepted) << k;
      EXPECT_EQ(intersections(*simulator), 0u) << k;
      notes.insert(notes.end(), last.notes.begin(), last.notes.end());
    }
  }

  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Simulator> simulator;
  StepReport last;
  std::vector<std::string> notes;
};

TEST(Seams, AreBroughtTogetherByAScriptedHandAndBearTheClothAfterwards) {
  const ScriptedRun run("seam_by_hand.json", 360);
  ASSERT_EQ(run.notes.size(), 1u);
  EXPECT_EQ(run.notes[0].find("seam 'front': welded at "), 0u) << run.notes[0];
  EXPECT_NE(run.notes[0].find("17 pairs"), std::string::npos) << run.notes[0];
  EXPECT_EQ(run.last.open_pairs, 0);
  EXPECT_LT(run.last.max_strain, 0.1);

  // The hand holds the right panel high, and the left one hangs from it.
  std::vector<Vec3f> x;
  run.simulator->positions(x);
  float highest = 0;
  for (std::size_t v = 0; v < 289; ++v) highest = std::max(highest, x[v].y);
  EXPECT_GT(highest, 0.05f);
}

TEST(Seams, HeldApartByABodyAreNamedOnceWithTheirGap) {
  const ScriptedRun run("seam_held_apart.json", 400);
  ASSERT_EQ(run.notes.size(), 1u);
  EXPECT_EQ(run.notes[0], "seam 'front': 1 cm apart, held apart by obstacle 'ruler'");
  EXPECT_EQ(run.last.open_pairs, 17);
  EXPECT_EQ(run.last.stuck_pairs, 17);
  EXPECT_GT(run.last.seam_gap, 0.01);  // the ruler is so thick
  EXPECT_LT(run.last.max_strain, 0.1);
}

/// Two sheets whose outer borders are held.
std::shared_ptr<Scene> held_sheets(double gap) {
  const auto scene = two_sheets(gap);
  Cloth& cloth = scene->cloths[0];
  const auto count = cloth.mesh.positions.size() / 2;
  for (const Index v : border(cloth.mesh, 0, count, false)) cloth.pins.push_back(v);
  for (const Index v : border(cloth.mesh, count, 2 * count, true)) cloth.pins.push_back(v);
  return scene;
}

TEST_P(SeamBuilds, WeldSheetsThatHaveToBeStretched) {
  const auto scene = held_sheets(0.02);
  const auto simulator = make_simulator(GetParam(), scene);
  ASSERT_GT(steps_to_weld(*simulator, 300), 0);
  StepReport report;
  for (int k = 0; k < 50; ++k) report = simulator->step({});
  EXPECT_NEAR(report.max_strain, 0.05, 0.02);  // 2 cm in 40
}

TEST(Seams, ThatWouldHaveToStretchTheClothTooFarStayOpenAndAreNamed) {
  const auto simulator = make_simulator(Build::cpu32, held_sheets(0.12));
  std::vector<std::string> notes;
  StepReport report;
  for (int k = 0; k < 500; ++k) {
    report = simulator->step({});
    ASSERT_TRUE(report.accepted) << k;
    notes.insert(notes.end(), report.notes.begin(), report.notes.end());
  }
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("comes no nearer, with nothing between its sides"), std::string::npos);
  EXPECT_GT(report.seam_gap, 0.01);
}

/// A sheet that is held at its top, and another one of `height` below it; the second cloth is sewn
/// to the first one.
std::shared_ptr<Scene> sheet_below_a_sheet(double gap) {
  const auto scene = std::make_shared<Scene>();
  const auto add = [&](const char* name, double y) {
    scene->cloths.push_back(make_sheet(hanging(kSheetSize, 120), {0, y, 0}));
    scene->cloths.back().name = name;
  };
  add("shirt", 0.5 * (kSheetSize + gap));
  add("skirt", -0.5 * (kSheetSize + gap));

  // Rows from left to right: the lowest of the shirt and the highest of the skirt.
  const auto row = [&](const TriangleMesh& mesh, bool top) {
    std::vector<Index> found;
    double extreme = mesh.positions[0].y;
    for (const Vec3d& p : mesh.positions)
      extreme = top ? std::max(extreme, p.y) : std::min(extreme, p.y);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (std::fabs(mesh.positions[v].y - extreme) < 1e-6) found.push_back(static_cast<Index>(v));
    std::ranges::sort(found, {}, [&](Index v) { return mesh.positions[at(v)].x; });
    return found;
  };
  const TriangleMesh &shirt = scene->cloths[0].mesh, &skirt = scene->cloths[1].mesh;
  scene->cloths[0].pins = row(shirt, true);
  const std::vector<Index> from = row(shirt, false), to = row(skirt, true);
  Seam seam{"waist", 0, 1, {}, true};
  for (std::size_t i = 0; i < from.size(); ++i) seam.pairs.push_back({from[i], to[i]});
  scene->seams.push_back(seam);
  scene->parameters.wind.air_density = 0;
  return scene;
}

TEST_P(SeamBuilds, OfTwoClothsStaySpringsAndHoldForGood) {
  const auto scene = sheet_below_a_sheet(0.004);
  const Vec3d gravity = {scene->parameters.gravity.x, scene->parameters.gravity.y,
                         scene->parameters.gravity.z};
  scene->parameters.gravity.y = 0;
  const auto simulator = make_simulator(GetParam(), scene);
  std::vector<std::string> notes;
  StepReport report;
  const double closed = weld_tolerance(make_world(*scene).median_edge);
  int since = 0;
  for (int k = 0; k < 600; ++k) {
    report = simulator->step({});
    ASSERT_TRUE(report.accepted) << k;
    ASSERT_EQ(intersections(*simulator), 0u) << k;
    notes.insert(notes.end(), report.notes.begin(), report.notes.end());

    // As soon as it is closed the seam carries the weight of the skirt, and does not open again.
    if (notes.empty()) continue;
    if (since++ == 0) {
      Parameters parameters = simulator->parameters();
      parameters.gravity = {gravity.x, gravity.y, gravity.z};
      simulator->set_parameters(parameters);
    }
    ASSERT_LT(report.seam_gap, closed) << k;
  }
  EXPECT_GT(since, 200);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("springs hold the two cloths together"), std::string::npos) << notes[0];
}

// ---- the scene file ----------------------------------------------------------------------------

/// Two sheets of three columns and two rows of squares in one file, and a scene with seams.
std::shared_ptr<const Scene> load(const TemporaryFolder& folder, const std::string& seams) {
  std::string obj;
  for (const double x0 : {0.0, 0.5})
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x)
        obj += "v " + std::to_string(x0 + 0.1 * x) + " " + std::to_string(0.1 * y) + " 0\n";
  for (const int first : {1, 13})
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) {
        const int v = first + 4 * y + x;
        obj += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " +
               std::to_string(v + 5) + " " + std::to_string(v + 4) + "\n";
      }
  folder.write("panels.obj", obj);
  return load_scene(folder.write("scene.json", R"({"cloths": [{"name": "dress", "mesh":
      "panels.obj", "seams": )" + seams + "}]}"),
                    {});
}

TEST(SeamsOfAScene, AreRunsAlongBordersOrPairs) {
  const TemporaryFolder folder;
  const auto scene = load(folder, R"([{"name": "side", "from": [3, 11], "to": [12, 20]},
      {"pairs": [[0, 23]], "pull": false}])");
  ASSERT_EQ(scene->seams.size(), 2u);
  using Pairs = std::vector<std::array<Index, 2>>;
  EXPECT_EQ(scene->seams[0].name, "side");
  EXPECT_TRUE(scene->seams[0].pulls);
  EXPECT_EQ(scene->seams[0].pairs, (Pairs{{3, 12}, {7, 16}, {11, 20}}));
  EXPECT_EQ(scene->seams[1].pairs, (Pairs{{0, 23}}));
  EXPECT_FALSE(scene->seams[1].pulls);
}

TEST(SeamsOfAScene, OfUnequalRunsTakeTheNearestAlongTheWay) {
  const TemporaryFolder folder;
  const auto scene = load(folder, R"([{"from": [0, 3], "to": [12, 20]}])");
  using Pairs = std::vector<std::array<Index, 2>>;
  EXPECT_EQ(scene->seams[0].pairs, (Pairs{{0, 12}, {1, 16}, {3, 20}}));
}

TEST(SeamsOfAScene, ThatMakeNoSenseAreRefused) {
  const TemporaryFolder folder;
  struct Bad {
    const char *seams, *where, *expected;
  };
  const Bad bad[] = {
      {"[]", "cloths[0].seams", "at least one seam"},
      {"3", "cloths[0].seams", "value 3"},
      {R"(["front:3 back:5"])", "seams[0]", "pattern"},
      {R"([{"from": [3, 11]}])", "seams[0]", "to"},
      {R"([{"from": [3], "to": [12, 20]}])", "seams[0].from", "two or more"},
      {R"([{"from": [3, 24], "to": [12, 20]}])", "seams[0].from[1]", "value 24"},
      {R"([{"from": [3, 5], "to": [12, 20]}])", "seams[0].from[1]", "on the border"},
      {R"([{"from": [3, 20], "to": [12, 20]}])", "seams[0].from[1]", "same border"},
      {R"([{"from": [3, 3], "to": [12, 20]}])", "seams[0].from[1]", "another vertex"},
      {R"([{"pairs": []}])", "seams[0].pairs", "at least one pair"},
      {R"([{"pairs": [[1]]}])", "seams[0].pairs[0]", "[a, b]"},
      {R"([{"pairs": [[1, -1]]}])", "seams[0].pairs[0][1]", "value -1"},
      {R"([{"pairs": [[1, 2]]}])", "seams[0]", "without an edge"},
      {R"([{"pairs": [[1, 1]]}])", "seams[0]", "one pair"},
      {R"([{"pairs": [[1, 20], [1, 21]]}])", "seams[0]", "one pair"},
      {R"([{"pairs": [[0, 20]], "from": [1, 2]}])", "seams[0].from", "either"},
      {R"([{"pairs": [[0, 20]], "cloth": "coat"}])", "seams[0].cloth", "coat"},
      {R"([{"pairs": [[0, 20]], "pul": false}])", "seams[0]", "pull"},
      {R"([{"name": "a", "pairs": [[0, 20]]}, {"name": "a", "pairs": [[1, 21]]}])", "cloths",
       "twice"},
  };
  for (const Bad& b : bad) {
    SCOPED_TRACE(b.seams);
    try {
      load(folder, b.seams);
      ADD_FAILURE() << "was taken";
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(b.where), std::string::npos) << text;
      EXPECT_NE(text.find(b.expected), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace icloth
