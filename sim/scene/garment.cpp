#include "sim/scene/garment.h"

#include <algorithm>

#include "kernels/index.h"
#include "sim/scene/scene.h"
#include "sim/scene/transforms.h"

namespace icloth {

Garment read_garment(const std::string& path, Index triangles, std::vector<std::string>& notes) {
  const Pattern pattern = read_pattern(path);
  Garment garment;
  garment.meshed = std::make_shared<const MeshedPattern>(
      mesh_pattern(pattern, edge_length_for(pattern, triangles)));
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
