// A place on the cloth in words and as JSON.
#include "app/common/cloth_place.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/small_scenes.h"

namespace icloth {
namespace {

TEST(ClothPlace, TellsFaceVerticesPositionAndStrain) {
  Scene scene;
  scene.cloths.push_back(testing::make_sheet(testing::hanging(0.2, 60), {0, 0, 0}));
  scene.cloths[0].name = "flag \"one\"";
  const World world = make_world(scene);
  const ElementNames names(scene);

  // The sheet is drawn out to 1.05 of its width.
  std::vector<Vec3f> positions;
  for (const Vec3d p : world.position)
    positions.push_back(convert<float>(Vec3d{1.05 * p.x, p.y, p.z}));
  const ClothPlace place = cloth_place(world, names, positions, 3, {0.5, 0.25, 0.25});
  EXPECT_NEAR(place.strain, 0.05, 1e-5);
  EXPECT_TRUE(place.text().ends_with(" face 3: strain 5.0 %")) << place.text();

  const auto json = nlohmann::json::parse(place.json());
  EXPECT_EQ(json["face"], place.face);
  EXPECT_EQ(json["vertices"].size(), 3u);
  Vec3d expected{};
  const double weights[] = {0.5, 0.25, 0.25};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(world.face[3][k]);
    expected += weights[k] * convert<double>(positions[v]);
    EXPECT_EQ(json["vertices"][k], names.vertex(world.face[3][k]));
  }
  EXPECT_NEAR(json["position"][0], expected.x, 1e-9);
  EXPECT_NEAR(json["position"][1], expected.y, 1e-9);
  EXPECT_NEAR(json["strain"], 0.05, 1e-5);
}

}  // namespace
}  // namespace icloth
