// Crossing sheets for the tests of the impact zones. Included after ICLOTH_BUILD and ICLOTH_REAL
// are defined.
#pragma once

#include <vector>

#include "kernels/index.h"
#include "sim/collision/impact_zones.h"
#include "tests/support/stage_support.h"

namespace icloth::ICLOTH_BUILD {

/// A millimetre in some direction for each vertex of a cloth; the same numbers in every build.
inline std::vector<Vec3r> shaken(const Stage& stage, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1e-3f, 1e-3f);
  std::vector<Vec3r> out(stage.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3f v{uniform(random), uniform(random), uniform(random)};
    if (static_cast<Index>(i) < stage.world.cloth_vertices) out[i] = convert<Real>(v);
  }
  return out;
}

/// Three pairs of sheets that pass through each other, and a sheet that falls into a ball.
struct Crossing {
  Stage stage;
  BroadPhase broad_phase;
  Ccd ccd;
  ImpactZones zones;

  static Scene scene(bool ball) {
    Scene scene;
    for (int pair = 0; pair < 3; ++pair) {
      const Vec3d place{0.5 * pair, 0, 0};
      scene.cloths.push_back(
          testing::make_sheet(testing::lying(0.1 + 0.05 * pair, 60 + 60 * pair), place));
      scene.cloths.push_back(
          testing::make_sheet(testing::lying(0.12, 70), place + Vec3d{0.01, 0.004, 0.013}));
    }
    if (!ball) return scene;
    scene.cloths.push_back(testing::make_sheet(testing::lying(0.2, 100), {0, 0.105, 1}));
    scene.obstacles.push_back(testing::make_obstacle(make_sphere(0.1, 180), {0, 0, 1}));
    return scene;
  }

  explicit Crossing(bool ball, Real speed = Real(0.004)) : stage(scene(ball)) {
    std::mt19937 random(1);
    stage.start = sum(stage.start, shaken(stage, random));
    stage.state.x0.upload(stage.start);
    std::vector<Vec3r> end = sum(stage.start, shaken(stage, random));
    for (Index i = 0; i < stage.world.cloth_vertices; ++i) {
      const bool upper = stage.world.object[at(i)] % 2 == 1;
      end[at(i)].y += stage.world.object[at(i)] == 6 ? -2 * speed : (upper ? -speed : speed);
    }
    stage.set_end(end);
    zones.begin_substep();
  }

  void find(bool incremental = false) {
    SubstepContext step = stage.context();
    broad_phase.cover_candidate(step);
    ccd.find(step, broad_phase, zones.dirty(), incremental);
  }
  void solve() {
    SubstepContext step = stage.context();
    zones.solve(step, ccd.impacts());
  }
};

/// Two large sheets that pass through each other everywhere: one zone.
struct CrossingSheets {
  Stage stage;
  BroadPhase broad_phase;
  Ccd ccd;
  ImpactZones zones;

  static Scene scene() {
    Scene scene;
    for (int sheet = 0; sheet < 2; ++sheet)
      scene.cloths.push_back(testing::make_sheet(testing::lying(0.5, 2400), {0, 0.004 * sheet, 0}));
    return scene;
  }

  explicit CrossingSheets(ZoneSolver solver) : stage(scene()) {
    stage.parameters.impact_zones.solver = solver;
    std::vector<Vec3r> end = stage.start;
    for (Index i = 0; i < stage.world.cloth_vertices; ++i)
      end[at(i)].y += stage.world.object[at(i)] == 1 ? Real(-0.004) : Real(0.004);
    stage.set_end(end);
    zones.begin_substep();
  }

  void solve() {
    SubstepContext step = stage.context();
    broad_phase.cover_candidate(step);
    ccd.find(step, broad_phase, zones.dirty(), false);
    zones.solve(step, ccd.impacts());
  }
};

/// How far the constraint of the impact is open at x [m].
inline double gap(const Impact& impact, const std::vector<Vec3r>& x) {
  Vec3d sum;
  for (int a = 0; a < 4; ++a)
    sum += static_cast<double>(impact.s.w[a]) * convert<double>(x[at(impact.s.v[a])]);
  return dot(convert<double>(impact.normal), sum);
}

}  // namespace icloth::ICLOTH_BUILD
