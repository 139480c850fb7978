#include "sim/scene/garment.h"

#include <algorithm>

#include "kernels/index.h"
#include "sim/pattern/divide_pattern.h"
#include "sim/scene/scene.h"
#include "sim/scene/transforms.h"

namespace icloth {
namespace {

std::shared_ptr<const MeshedPattern> mesh_with(const Pattern& pattern, Index triangles) {
  return std::make_shared<const MeshedPattern>(mesh_with_count(pattern, triangles));
}

/// Meshes the pattern coarse and divides it until it has about so many triangles. Does nothing and
/// returns false where they are few, or the divided pattern would not be sewn as the coarse one is.
bool mesh_in_levels(const Pattern& pattern, Index triangles, Garment& garment) {
  if (triangles > kMostPatternTriangles) return false;  // meshing it as a whole says why
  Index coarsest = triangles;
  int levels = 0;
  for (; coarsest > kMostDressedTriangles; coarsest /= 4) ++levels;
  if (levels == 0) return false;

  // Each level is sewn as well, which tells whether it fits the one before.
  std::shared_ptr<const MeshedPattern> meshed = mesh_with(pattern, coarsest);
  const std::vector<PanelPlacement> placements = placements_of(pattern);
  SewnGarment sewn = sew_panels(*meshed, placements);
  std::vector<PatternDivision> divisions;
  for (int level = 0; level < levels; ++level) {
    DividedPattern divided = divide_pattern(*meshed);
    SewnGarment finer = sew_panels(divided.meshed, placements);
    if (!is_sewn_alike(sewn, finer)) return false;
    auto fine = std::make_shared<const MeshedPattern>(std::move(divided.meshed));
    divisions.push_back({std::move(meshed), fine, std::move(divided.parents)});
    meshed = std::move(fine);
    sewn = std::move(finer);
  }

  garment.meshed = std::move(meshed);
  garment.divisions = std::move(divisions);
  return true;
}

}  // namespace

Garment read_garment(const std::string& path, Index triangles, std::vector<std::string>& notes) {
  const Pattern pattern = read_pattern(path);
  Garment garment;
  if (!mesh_in_levels(pattern, triangles, garment)) garment.meshed = mesh_with(pattern, triangles);
  garment.placements = placements_of(pattern);
  notes.insert(notes.end(), pattern.notes.begin(), pattern.notes.end());
  notes.insert(notes.end(), garment.meshed->notes.begin(), garment.meshed->notes.end());
  return garment;
}

void sew_garment(Garment& garment, Cloth& cloth) {
  garment.sewn = sew_panels(*garment.meshed, garment.placements);

  // The garment as a whole goes to where its wearer stands.
  const Eigen::AngleAxisd turn = angle_axis(garment.rotation);
  const auto place = [&](Vec3d& p) { p = from_eigen(turn * to_eigen(p)) + garment.translation; };
  std::ranges::for_each(garment.sewn.mesh.positions, place);
  std::ranges::for_each(garment.sewn.open_positions, place);

  cloth.mesh = std::move(garment.sewn.mesh);
  cloth.rest = cloth.mesh.positions;
  cloth.rest_in_uv = true;
}

std::vector<bool> gathered_faces(const Garment& garment, const Cloth& cloth) {
  // The vertices of gathered seams are the first ring.
  std::vector<bool> reached(cloth.mesh.positions.size());
  for (const SewnSeam& seam : garment.sewn.seams) {
    if (gather_ratio(seam) <= kGatherRatio) continue;
    for (const auto& pair : seam.points)
      for (Index open : pair) reached[at(garment.sewn.merged[at(open)])] = true;
  }

  // Each ring adds the faces that touch the vertices so far, and their vertices.
  std::vector<bool> gathered(cloth.mesh.faces.size());
  for (int ring = 0; ring < kGatherRings; ++ring) {
    for (std::size_t f = 0; f < gathered.size(); ++f)
      for (Index v : cloth.mesh.faces[f]) gathered[f] = gathered[f] || reached[at(v)];
    for (std::size_t f = 0; f < gathered.size(); ++f)
      if (gathered[f])
        for (Index v : cloth.mesh.faces[f]) reached[at(v)] = true;
  }
  return gathered;
}

}  // namespace icloth
