// Which coefficient of friction a pair has: that of the parameters, of the body or of the cloths.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

#include "sim/collision/proximity.h"
#include "tests/support/stage_support.h"

namespace icloth::cpu32 {
namespace {

/// From below: body, four sheets, body; 1 mm apart.
Scene stack(const std::array<std::optional<double>, 6>& friction) {
  Scene scene;
  for (int k = 0; k < 4; ++k) {
    // Turned a little against each other, so that edges cross.
    scene.cloths.push_back(testing::make_sheet(testing::lying(0.1, 60), {0, 0.001 * k, 0}));
    const double c = std::cos(0.2 * k), s = std::sin(0.2 * k);
    for (Vec3d& p : scene.cloths.back().mesh.positions)
      p = {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
    scene.cloths.back().friction = friction[static_cast<std::size_t>(k) + 1];
  }
  for (const double y : {-0.011, 0.014}) {
    scene.obstacles.push_back(
        testing::make_obstacle(make_box({0.07, 0.02, 0.06}, 0.02), {0.004, y, 0.003}));
    scene.obstacles.back().friction = friction[y < 0 ? 0 : 5];
  }
  scene.parameters.proximity.thickness = 1.5e-3;
  scene.parameters.proximity.friction_cloth = 0.5;
  scene.parameters.proximity.friction_obstacle = 0.25;
  return scene;
}

using Objects = std::pair<Index, Index>;  ///< the smaller first; sheets 0 … 3, bodies 4 and 5

/// Coefficients of the contacts between two objects, of both kinds of pairs.
std::map<Objects, std::set<Real>> coefficients(const Scene& scene) {
  Stage stage(scene);
  SubstepContext step = stage.context();
  BroadPhase broad_phase;
  broad_phase.prepare(step);
  Proximity proximity;
  proximity.find(step, broad_phase);
  std::map<Objects, std::set<Real>> out;
  std::map<Objects, std::set<bool>> kinds;
  for (const Contact& c : proximity.contacts().download()) {
    const auto object_of = [&](int corner) {
      return stage.world.object[static_cast<std::size_t>(c.s.v[corner])];
    };
    const Objects pair = std::minmax(Index{object_of(0)}, Index{object_of(2)});
    out[pair].insert(c.friction);
    kinds[pair].insert(key_is_edge_edge(c.key));
  }
  for (const Objects& pair :
       {Objects{0, 4}, Objects{0, 1}, Objects{1, 2}, Objects{2, 3}, Objects{3, 5}})
    EXPECT_EQ(kinds[pair].size(), 2u) << pair.first << " " << pair.second;
  return out;
}

TEST(Friction, IsThatOfTheParametersWhereNoObjectHasItsOwn) {
  const Scene scene = stack({});
  Topology mesh;
  mesh.upload(make_world(scene));
  EXPECT_TRUE(mesh.object_friction.empty());
  for (const auto& [pair, values] : coefficients(scene))
    EXPECT_EQ(values, (std::set<Real>{pair.second > 3 ? Real(0.25) : Real(0.5)}));
}

TEST(Friction, OfABodyComesFirstAndThatOfTwoClothsIsTheirMean) {
  auto found = coefficients(stack({0.75, 0.25, 1.0, {}, {}, {}}));
  const auto of = [&](Index a, Index b) { return found[Objects{a, b}]; };
  EXPECT_EQ(of(0, 4), (std::set<Real>{Real(0.75)}));  // not that of the sheet
  EXPECT_EQ(of(0, 1), (std::set<Real>{Real(0.5)}));   // √(0.25 · 1)
  EXPECT_EQ(of(1, 2), (std::set<Real>{Real(1)}));
  EXPECT_EQ(of(2, 3), (std::set<Real>{Real(0.5)}));
  EXPECT_EQ(of(3, 5), (std::set<Real>{Real(0.25)}));
}

TEST(Friction, ZeroIsAValueOfItsOwn) {
  auto found = coefficients(stack({0.0, 0.0, 1.0, {}, 0.0, 0.0}));
  for (const Objects& pair : {Objects{0, 4}, Objects{0, 1}, Objects{2, 3}, Objects{3, 5}})
    EXPECT_EQ(found[pair], (std::set<Real>{Real(0)}));
}

}  // namespace
}  // namespace icloth::cpu32
