#include "sim/garment/refine.h"

#include <algorithm>

#include "kernels/index.h"

namespace icloth {
namespace {

int levels_of(const Garment& garment) { return static_cast<int>(garment.divisions.size()); }

/// Divides one garment in place: new vertices lie in the middle of those that they come from.
void refine(Garment& garment, Cloth& cloth, const PatternDivision& division) {
  const std::vector<Vec3d> before = std::move(cloth.mesh.positions);
  const std::vector<Index> merged_before = std::move(garment.sewn.merged);
  garment.meshed = division.fine;
  sew_garment(garment, cloth);

  // Vertices that are sewn together all come from the same places.
  std::size_t open = 0, first = 0;
  for (std::size_t p = 0; p < division.parents.size(); ++p) {
    for (const auto& [a, b] : division.parents[p]) {
      const auto place = [&](Index v) { return before[at(merged_before[first + at(v)])]; };
      cloth.mesh.positions[at(garment.sewn.merged[open++])] = 0.5 * (place(a) + place(b));
    }
    first += division.coarse->panels[p].points.size();
  }
}

}  // namespace

int refinements(const Scene& scene) {
  int levels = 0;
  for (const Garment& garment : scene.garments) {
    if (!scene.cloths[at(garment.cloth)].pins.empty() || !scene.seams.empty()) return 0;
    levels = std::max(levels, levels_of(garment));
  }
  return levels;
}

Scene coarsest_scene(const Scene& scene) {
  Scene coarse = scene;
  for (Garment& garment : coarse.garments) {
    if (garment.divisions.empty()) continue;
    garment.meshed = garment.divisions.front().coarse;
    sew_garment(garment, coarse.cloths[at(garment.cloth)]);
  }
  return coarse;
}

void refine_garments(Scene& scene, int level) {
  for (Garment& garment : scene.garments)
    if (level < levels_of(garment))
      refine(garment, scene.cloths[at(garment.cloth)],
             garment.divisions[static_cast<std::size_t>(level)]);
}

}  // namespace icloth
