// A scene that is opened behind the window: progress is seen, and nobody has to wait.
#include "app/session/scene_opening.h"

#include <gtest/gtest.h>

#include <functional>

#include "app/session/garment_gauge.h"
#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/garment/open_scene.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

using Clock = std::chrono::steady_clock;

/// A front and a back that are sewn to a tube round a capsule.
constexpr const char* kTube = R"({"pattern": {"panels": {
  "front": {"vertices": [[-22, 0], [22, 0], [22, 30], [-22, 30]], "edges": [{"endpoints": [0, 1]},
    {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
    "translation": [0, 100, 20], "rotation": [0, 0, 0]},
  "back": {"vertices": [[-22, 0], [22, 0], [22, 30], [-22, 30]], "edges": [{"endpoints": [0, 1]},
    {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}],
    "translation": [0, 100, -20], "rotation": [0, 180, 0]}},
  "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}],
               [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1}]]},
  "properties": {"units_in_meter": 100}})";
constexpr const char* kScene = R"({"cloths": [{"name": "tube", "pattern": "tube.json",
  "triangles": 300}], "obstacles": [{"name": "trunk", "mesh": {"capsule": {"radius": 0.1,
  "length": 0.6, "triangles": 300}}, "transform": {"translate": [0, 1.15, 0]}}]})";

class SceneOpeningTest : public ::testing::Test {
 protected:
  SceneOpeningTest() {
    setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
    folder_.write("tube.json", kTube);
    scene_ = folder_.write("scene.json", kScene);
  }
  ~SceneOpeningTest() override { unsetenv("XDG_CACHE_HOME"); }

  SceneOpening::Open open_tube() const {
    return [scene = scene_](SceneOrigin& origin, const DressingWatch& watch) {
      return open_scene(scene, {}, &origin, watch);
    };
  }

  TemporaryFolder folder_;
  std::string scene_;
};

/// Looks at the opening as the window does until it is done; false after a minute.
bool wait(SceneOpening& opening, const std::function<void(const DressingPicture&)>& look) {
  const auto end = Clock::now() + std::chrono::seconds(60);
  while (!opening.done() && Clock::now() < end) {
    if (opening.take()) look(opening.picture());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return opening.done();
}

TEST_F(SceneOpeningTest, ShowsTheGarmentWhileItIsPutOn) {
  SceneOpening opening(open_tube());
  int pictures = 0, last = 0;
  bool settled = false;
  ASSERT_TRUE(wait(opening, [&](const DressingPicture& picture) {
    ++pictures;
    EXPECT_EQ(picture.garment, "tube");
    ASSERT_NE(picture.world, nullptr);
    EXPECT_EQ(picture.positions.size(), at(picture.world->vertices));
    EXPECT_LE(picture.step, picture.most_steps);
    const bool is_same_stage = picture.settling == settled;
    EXPECT_TRUE(!is_same_stage || picture.step >= last);
    settled = picture.settling;
    last = picture.step;
  }));
  EXPECT_GT(pictures, 1);
  const auto scene = opening.scene();
  ASSERT_NE(scene, nullptr);

  // What the window says of it.
  const World world = make_world(*scene);
  std::vector<Vec3f> positions;
  for (const Vec3d& p : world.position) positions.push_back(convert<float>(p));
  const auto states = GarmentGauge(*scene, world).measure(positions);
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0].name, "tube");
  EXPECT_GT(states[0].pairs, 10u);
  EXPECT_EQ(states[0].open_pairs, 0u);
  EXPECT_GT(states[0].strain_p95, 0);
  EXPECT_LT(states[0].strain_p95, 0.1);
}

TEST_F(SceneOpeningTest, CancelsInTheMidstOfDressing) {
  SceneOpening opening(open_tube());
  ASSERT_TRUE(wait(opening, [&](const DressingPicture&) { opening.cancel(); }));
  EXPECT_EQ(opening.scene(), nullptr);
}

TEST_F(SceneOpeningTest, HandsOnWhatOpeningThrows) {
  SceneOpening opening([](SceneOrigin&, const DressingWatch&) -> std::shared_ptr<const Scene> {
    throw InputError("no such scene");
  });
  ASSERT_TRUE(wait(opening, [](const DressingPicture&) {}));
  EXPECT_THROW(opening.scene(), InputError);
}

TEST(GarmentGauge, MeasuresTheGapsOfOpenSeamsAndTheStretch) {
  // Two triangles with a seam between them, 3 cm apart, one of them stretched by a tenth.
  Scene scene;
  Cloth cloth;
  cloth.name = "pair";
  cloth.mesh.positions = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},
                          {-0.03, 0, 0}, {-0.03, 1, 0}, {-1.03, 0, 0}};
  cloth.mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  cloth.rest = cloth.mesh.positions;
  scene.cloths.push_back(cloth);
  scene.seams.push_back({"side", 0, 0, {{0, 3}, {2, 4}}, true});
  const World world = make_world(scene);
  const GarmentGauge gauge(scene, world);

  std::vector<Vec3f> positions;
  for (const Vec3d& p : world.position) positions.push_back(convert<float>(p));
  positions[1].x = 1.1f;
  GarmentState state = gauge.measure(positions).at(0);
  EXPECT_EQ(state.pairs, 2u);
  EXPECT_EQ(state.open_pairs, 2u);
  EXPECT_NEAR(state.gap, 0.03, 1e-6);
  EXPECT_NEAR(state.largest_strain, 0.1, 1e-6);
  EXPECT_EQ(garment_text(state), "sewn 0/2, max gap 30 mm, strain p95 10.0 %");

  // One pair is shut.
  positions[3] = positions[0];
  state = gauge.measure(positions).at(0);
  EXPECT_EQ(state.open_pairs, 1u);
  EXPECT_EQ(total(std::vector{state, state}).open_pairs, 2u);
}

}  // namespace
}  // namespace icloth
