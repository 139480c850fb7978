// Sheets that cross each other at the start, and how a repair of them is judged.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "kernels/distance.h"
#include "sim/scene/intersections.h"
#include "sim/scene/repair.h"
#include "sim/scene/repair_mesh.h"
#include "sim/simulator.h"
#include "tests/support/small_scenes.h"

namespace icloth::testing {

/// A sheet whose points are moved by `shape`.
inline Cloth shaped_sheet(double size, Index triangles, const std::function<Vec3d(Vec3d)>& shape) {
  Cloth cloth = make_sheet(lying(size, triangles), {});
  for (Vec3d& p : cloth.mesh.positions) p = shape(p);
  return cloth;
}

/// Smallest distance of all pairs of vertex and face, and of edges, that share no vertex. Slow.
inline double smallest_gap(const Scene& scene) {
  const RepairMesh mesh(scene);
  double least2 = std::numeric_limits<double>::infinity();
  const auto x = [&](Index v) { return mesh.position(v); };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle t = mesh.faces[f];
    for (Index v = 0; v < static_cast<Index>(mesh.x.size()); ++v) {
      const bool fixed = !mesh.is_free(v) && mesh.group[f] < 0;
      if (fixed || v == t[0] || v == t[1] || v == t[2]) continue;
      const auto p = closest_point_triangle(x(v), x(t[0]), x(t[1]), x(t[2]));
      least2 = std::min(least2, p.distance2);
    }
  }
  for (const auto& [a, b] : mesh.edges)
    for (const auto& [c, d] : mesh.edges) {
      const bool free = mesh.is_free(a) || mesh.is_free(b) || mesh.is_free(c) || mesh.is_free(d);
      if (!free || a == c || a == d || b == c || b == d) continue;
      const auto p = closest_points_segments(x(a), x(b), x(c), x(d));
      least2 = std::min(least2, p.distance2);
    }
  return std::sqrt(least2);
}

/// Repairs the scene; nothing may be left, nobody may have moved further than the depth [m] and the
/// offset, all is apart by the offset, and the solver accepts the first steps.
inline void expect_repaired(const Scene& crossing, double depth, const char* what) {
  auto scene = std::make_shared<Scene>(crossing);
  ASSERT_FALSE(find_start_intersections(*scene, true).empty()) << what;
  const StartRepair repair = repair_start(*scene, 0.015);
  const double offset = scene->parameters.impact_zones.offset;
  EXPECT_GT(repair.pairs_before, 0u) << what;
  EXPECT_EQ(repair.pairs_left, 0u) << what;
  EXPECT_TRUE(find_start_intersections(*scene, true).empty()) << what;
  EXPECT_LE(repair.largest_move, 1.02 * (depth + offset)) << what;
  EXPECT_GT(smallest_gap(*scene), 0.9 * offset) << what;
  for (std::size_t c = 0; c < scene->cloths.size(); ++c) {
    EXPECT_TRUE(scene->cloths[c].rest == crossing.cloths[c].rest) << what;
    for (const Index pin : scene->cloths[c].pins) {
      const auto v = static_cast<std::size_t>(pin);
      EXPECT_TRUE(scene->cloths[c].mesh.positions[v] == crossing.cloths[c].mesh.positions[v])
          << what;
    }
  }
  const auto simulator = make_simulator(Build::cpu32, scene);
  for (int step = 0; step < 5; ++step) EXPECT_TRUE(simulator->step({}).accepted) << what;
}

}  // namespace icloth::testing
