// How garments are worn, measured on a body that moves: against positions that are made for it, and
// against a simulated skirt that is too wide.
#include "app/session/garment_fit.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "kernels/index.h"
#include "sim/files/assets.h"
#include "sim/files/file_io.h"
#include "sim/garment/open_scene.h"
#include "sim/scene/scene_io.h"
#include "sim/simulator.h"
#include "tests/support/temporary_folder.h"

namespace icloth {
namespace {

/// A woman who dances in a garment; `more` are further keys of the cloth.
std::string scene_text(const std::string& pattern, const std::string& more) {
  return R"({ "cloths": [ { "name": "worn", "pattern": ")" + pattern +
         R"(", "triangles": 1500, "on": "woman", )" + more +
         R"( } ], "obstacles": [ { "name": "woman", "mesh": "bodies/woman.glb", "clip": "dance" } ] })";
}

/// The woman in a T-shirt that is sewn where the pattern places it, and not put on.
std::shared_ptr<const Scene> tee_as_sewn(const TemporaryFolder& folder) {
  const std::string text = scene_text("garments/tee_specification.json", R"("dress": false)");
  return load_scene(folder.write("tee.json", text), {});
}

/// The start positions of all vertices of a scene.
std::vector<Vec3f> start_of(const Scene& scene) {
  std::vector<Vec3f> positions;
  for (const Vec3d& p : make_world(scene).position) positions.push_back(convert<float>(p));
  return positions;
}

/// All points moved by the same way [m].
std::vector<Vec3f> moved(std::vector<Vec3f> positions, Vec3f way) {
  for (Vec3f& p : positions) p = p + way;
  return positions;
}

TEST(GarmentFit, MeasuresHowFarABorderHasSlid) {
  const TemporaryFolder folder;
  const auto scene = tee_as_sewn(folder);
  const GarmentFitGauge gauge(*scene);
  const std::vector<Vec3f> start = start_of(*scene);

  // Nothing has moved at time 0; then all is moved by 12 cm.
  const GarmentFit before = gauge.measure(start, 0).front();
  EXPECT_EQ(before.name, "worn");
  EXPECT_FALSE(before.waist.has_value());
  ASSERT_TRUE(before.collar.has_value());
  EXPECT_LT(*before.collar, 1e-6);
  const GarmentFit after = gauge.measure(moved(start, {0, -0.12f, 0}), 0).front();
  EXPECT_NEAR(*after.collar, 0.12, 1e-6);
  EXPECT_NEAR(after.largest_strain, before.largest_strain, 1e-4);
}

TEST(GarmentFit, FollowsTheBoneThatCarriesTheBorder) {
  const TemporaryFolder folder;
  const auto scene = tee_as_sewn(folder);
  const GarmentFitGauge gauge(*scene);
  const std::vector<Vec3f> start = start_of(*scene);

  // A garment that stays where it is while the body dances has left its place. In the course of the
  // dance the collar moves by some centimetres.
  double largest = 0;
  for (double time = 0; time < 8; time += 0.5)
    largest = std::max(largest, *gauge.measure(start, time).front().collar);
  EXPECT_GT(largest, 0.02);

  // One that every bone carries, as it does the skin, has not: each vertex moves with its nearest
  // vertex of the skin. The collar lies over several bones, so a little is left.
  std::vector<Vec3d> skin_before, skin;
  const Obstacle& woman = scene->obstacles.front();
  woman.pose(0, skin_before);
  const std::size_t vertices = scene->cloths.front().mesh.positions.size();
  std::vector<std::size_t> nearest(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec3d p = convert<double>(start[v]);
    const auto nearer = [&](const Vec3d& a, const Vec3d& b) { return norm(a - p) < norm(b - p); };
    nearest[v] = static_cast<std::size_t>(std::ranges::min_element(skin_before, nearer) -
                                          skin_before.begin());
  }
  for (double time = 0; time < 8; time += 0.5) {
    woman.pose(time, skin);
    std::vector<Vec3f> carried = start;
    for (std::size_t v = 0; v < vertices; ++v)
      carried[v] = carried[v] + convert<float>(skin[nearest[v]] - skin_before[nearest[v]]);
    EXPECT_LT(*gauge.measure(carried, time).front().collar, 0.01) << time << " s";
  }
}

TEST(GarmentFit, NamesThePanelOfTheLargestStrain) {
  const TemporaryFolder folder;
  const auto scene = tee_as_sewn(folder);
  const GarmentFitGauge gauge(*scene);
  std::vector<Vec3f> positions = start_of(*scene);

  // One vertex in the middle of a sleeve is pulled away by a metre.
  const SewnGarment& sewn = scene->garments.front().sewn;
  const auto face = static_cast<std::size_t>(std::ranges::find(sewn.panel, 2) - sewn.panel.begin());
  Vec3f& vertex = positions[at(scene->cloths.front().mesh.faces[face][0])];
  vertex = vertex + Vec3f{1, 0, 0};
  const GarmentFit fit = gauge.measure(positions, 0).front();
  EXPECT_GT(fit.largest_strain, 5);
  EXPECT_EQ(fit.panel, sewn.panel_names[2]);
}

/// Dresses a scene and runs it; returns the largest values of its only garment on the way.
GarmentFit run_and_measure(const std::string& file, int steps) {
  SceneOrigin origin;
  const auto scene = open_scene(file, {}, &origin);
  const GarmentFitGauge gauge(*scene);
  const auto simulator = make_simulator(Build::cpu32, scene);

  // No step may be refused, and a waist that is not measured counts as one that is far away.
  GarmentFit most;
  most.waist = 0;
  std::vector<Vec3f> positions;
  for (int step = 0; step < steps; ++step) {
    EXPECT_TRUE(simulator->step({}).accepted) << "step " << step;
    simulator->positions(positions);
    const GarmentFit fit = gauge.measure(positions, simulator->time()).front();
    most.largest_strain = std::max(most.largest_strain, fit.largest_strain);
    most.waist = std::max(*most.waist, fit.waist.value_or(1));
  }
  return most;
}

TEST(GarmentFit, ASkirtThatFitsStaysAndOneThatIsTooWideSlidesOff) {
  const TemporaryFolder folder;
  setenv("XDG_CACHE_HOME", folder.path("cache").c_str(), 1);
  const std::string hold =
      R"("material": "pink-ribbon-brown", "dress": { "settling": 0.5, "hold": ["lower_interface"] })";
  const GarmentFit fits = run_and_measure(
      folder.write("fits.json", scene_text("garments/bishop_skirt_specification.json", hold)), 30);
  EXPECT_LT(*fits.waist, 0.05);
  EXPECT_LT(fits.largest_strain, 0.3);

  // The same pattern in a unit that is half as large again: its waist is wider than the hips.
  std::string wide = read_file(find_asset("garments/bishop_skirt_specification.json", ""));
  const std::string unit = "\"units_in_meter\": 100";
  const std::size_t place = wide.find(unit);
  ASSERT_NE(place, std::string::npos);
  wide.replace(place, unit.size(), "\"units_in_meter\": 66");
  folder.write("wide.json", wide);
  const std::string lower = hold + R"(, "transform": { "translate": [0, -0.55, 0] })";
  const GarmentFit slides =
      run_and_measure(folder.write("slides.json", scene_text("wide.json", lower)), 30);
  EXPECT_GT(*slides.waist, 0.05);
}

}  // namespace
}  // namespace icloth
