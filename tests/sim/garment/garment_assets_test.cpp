// The garments of assets/garments, and the scene that wears two of them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <string>

#include "kernels/index.h"
#include "sim/files/assets.h"
#include "sim/garment/open_scene.h"
#include "sim/pattern/sewing.h"
#include "sim/scene/intersections.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

/// A garment as it was designed.
struct Design {
  const char* name;
  std::size_t panels, stitches;
  double area;         ///< [m²]
  double most_gather;  ///< of the lengths of stitched edges
};

constexpr Design kDesigns[] = {
    {"tee", 4, 10, 0.665, 1.03},          {"trousers", 4, 14, 0.93, 1.03},
    {"dress", 6, 18, 1.667, 1.03},        {"tank", 2, 4, 0.415, 1.03},
    {"tiered", 14, 32, 1.25, 1.31},       {"flounce", 4, 4, 0.559, 1.03},
    {"andy_shirt", 2, 4, 0.315, 1.03},    {"andy_trousers", 4, 14, 0.723, 1.03},
    {"andy_jacket", 5, 10, 0.614, 1.03},  {"bishop_blouse", 4, 10, 0.795, 1.03},
    {"bishop_skirt", 6, 12, 1.171, 1.03}, {"bishop_vest", 3, 4, 0.423, 1.03}};

class GarmentAsset : public ::testing::TestWithParam<Design> {};

TEST_P(GarmentAsset, HasThePanelsAreaAndSeamsOfItsDesign) {
  const Design& design = GetParam();
  const std::string file = std::string("garments/") + design.name + "_specification.json";
  const Pattern pattern = read_pattern(find_asset(file, ""));
  EXPECT_EQ(pattern.panels.size(), design.panels);
  EXPECT_EQ(pattern.stitches.size(), design.stitches);

  // Flat area, from the faces in material coordinates.
  const SewnGarment sewn = sew_pattern(pattern, edge_length_for(pattern, 1500));
  double area = 0;
  for (const auto& uv : sewn.mesh.uv) {
    const Vec2d a = uv[1] - uv[0], b = uv[2] - uv[0];
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  EXPECT_NEAR(area, design.area, 0.02 * design.area);

  for (const SewnSeam& seam : sewn.seams)
    EXPECT_LE(gather_ratio(seam), design.most_gather)
        << sewn.panel_names[at(seam.panel_a)] << ":" << seam.edge_a << " to "
        << sewn.panel_names[at(seam.panel_b)] << ":" << seam.edge_b;
  for (const std::string& note : sewn.notes)
    EXPECT_NE(note.find("gather"), std::string::npos) << note;
}

INSTANTIATE_TEST_SUITE_P(All, GarmentAsset, ::testing::ValuesIn(kDesigns),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(DressedScene, StartsWornAndDancesWithoutARefusedStep) {
  // Coarser than in the scene itself, and not from a cache that an earlier run may have left. Still
  // coarser faces cut through the hips, and the search of a start lowers the trousers. At this
  // number a contracted body, which the T-shirt would start around, reaches the trousers.
  const TemporaryFolder folder;
  setenv("XDG_CACHE_HOME", folder.path("cache").c_str(), 1);
  SceneOrigin origin;
  const auto scene = open_scene("dressed", std::vector<std::string>{"triangles=2400"}, &origin);
  for (const std::string& note : origin.notes)
    EXPECT_EQ(note.find("cannot be put on"), std::string::npos) << note;
  ASSERT_EQ(scene->garments.size(), 2u);
  EXPECT_TRUE(face_pairs(find_start_conflicts(*scene, true)).empty());

  const auto simulator = make_simulator(Build::cpu32, scene);
  for (int step = 0; step < 20; ++step) {
    const StepReport report = simulator->step({});
    EXPECT_TRUE(report.accepted) << "step " << step;
    EXPECT_LT(report.max_strain, 0.3) << "step " << step;
  }

  // The trousers hang from the hips and the T-shirt from the shoulders.
  const Snapshot state = simulator->snapshot();
  const std::size_t trousers = scene->cloths[0].mesh.positions.size();
  const std::size_t all = trousers + scene->cloths[1].mesh.positions.size();
  double highest = 0, lowest = 2;
  for (std::size_t v = 0; v < trousers; ++v) highest = std::max(highest, state.x1[v].y);
  for (std::size_t v = trousers; v < all; ++v) lowest = std::min(lowest, state.x1[v].y);
  EXPECT_NEAR(highest, 1.02, 0.05);
  EXPECT_LT(lowest, highest);
  EXPECT_GT(lowest, 0.80);
}

}  // namespace
}  // namespace icloth
