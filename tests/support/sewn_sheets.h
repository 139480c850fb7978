// Two sheets side by side, with a seam that pulls them together.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "kernels/index.h"
#include "sim/scene/scene.h"
#include "tests/support/small_scenes.h"

namespace icloth::testing {

inline constexpr double kSheetSize = 0.2;

/// Vertices of a sheet on its left or right border, from the bottom up.
inline std::vector<Index> border(const TriangleMesh& mesh, std::size_t first, std::size_t end,
                                 bool right) {
  double extreme = right ? -1e9 : 1e9;
  for (std::size_t v = first; v < end; ++v)
    extreme =
        right ? std::max(extreme, mesh.positions[v].x) : std::min(extreme, mesh.positions[v].x);
  std::vector<Index> found;
  for (std::size_t v = first; v < end; ++v)
    if (std::fabs(mesh.positions[v].x - extreme) < 1e-6) found.push_back(static_cast<Index>(v));
  std::ranges::sort(found, {}, [&](Index v) { return mesh.positions[at(v)].y; });
  return found;
}

/// One cloth of two hanging sheets with a gap between them, and a seam along it.
inline std::shared_ptr<Scene> two_sheets(double gap, bool pulls = true, Index triangles = 120) {
  auto scene = std::make_shared<Scene>();
  scene->name = "sheets";
  Cloth left = make_sheet(hanging(kSheetSize, triangles), {-0.5 * (kSheetSize + gap), 0, 0});
  const Cloth right = make_sheet(hanging(kSheetSize, triangles), {0.5 * (kSheetSize + gap), 0, 0});
  const auto count = left.mesh.positions.size();
  left.mesh.positions.insert(left.mesh.positions.end(), right.mesh.positions.begin(),
                             right.mesh.positions.end());
  for (const Vec3d& p : right.rest) left.rest.push_back(p + Vec3d{1, 0, 0});
  left.mesh.uv.insert(left.mesh.uv.end(), right.mesh.uv.begin(), right.mesh.uv.end());
  for (Triangle t : right.mesh.faces) {
    for (Index& v : t) v += static_cast<Index>(count);
    left.mesh.faces.push_back(t);
  }

  Seam seam;
  seam.name = "side";
  seam.pulls = pulls;
  const std::vector<Index> from = border(left.mesh, 0, count, true);
  const std::vector<Index> to = border(left.mesh, count, left.mesh.positions.size(), false);
  EXPECT_EQ(from.size(), to.size());
  for (std::size_t i = 0; i < from.size(); ++i) seam.pairs.push_back({from[i], to[i]});
  scene->seams.push_back(seam);
  scene->cloths.push_back(std::move(left));
  scene->parameters.wind.air_density = 0;
  scene->parameters.gravity.y = 0;
  return scene;
}

}  // namespace icloth::testing
