#include "sim/scene/panel_sewing.h"

#include <optional>
#include <utility>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/scene/repair.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/seam_weld.h"

namespace icloth {
namespace {

constexpr int kOpenRings = 4;  ///< rings of faces beside which pairs stay open

/// Makes one vertex of every pair, halfway between the two, and parts what then intersects.
SewnPanels weld_and_part(Scene scene, const Seam& seam, const std::string& source) {
  scene.seams = {seam};
  std::optional<WeldedScene> welded = weld_seam(scene, make_world(scene), 0);
  if (!welded)
    throw InputError(source +
                     ": the seams leave faces without an area, expected a smaller --within");
  SewnPanels sewn{.scene = std::move(welded->scene), .repair = {}, .left = {}};
  sewn.scene.seams.clear();
  fit_thickness(sewn.scene);

  sewn.pairs = face_pairs(find_start_conflicts(sewn.scene, true)).size();
  sewn.repair = repair_start(sewn.scene, median_edge(sewn.scene));
  sewn.left = face_pairs(find_start_conflicts(sewn.scene, true));
  return sewn;
}

/// Takes the pairs out of a seam that lie within so many rings of faces that intersect. The numbers
/// of faces are the same before and after the weld, and those of bodies come after them.
void open_beside(const TriangleMesh& mesh, const std::vector<IntersectingFaces>& left, int reach,
                 Seam& seam) {
  std::vector<bool> near(mesh.positions.size());
  for (const IntersectingFaces& pair : left)
    for (const Index face : {pair.a, pair.b})
      if (at(face) < mesh.faces.size())
        for (const Index v : mesh.faces[at(face)]) near[at(v)] = true;

  // Each ring grows over the faces, and over the seam, by one.
  for (int ring = 0; ring < reach; ++ring) {
    std::vector<bool> grown = near;
    for (const Triangle& t : mesh.faces)
      if (near[at(t[0])] || near[at(t[1])] || near[at(t[2])])
        for (const Index v : t) grown[at(v)] = true;
    for (const auto& [a, b] : seam.pairs)
      if (near[at(a)] || near[at(b)]) grown[at(a)] = grown[at(b)] = true;
    near = std::move(grown);
  }
  std::erase_if(seam.pairs, [&](const auto& p) { return near[at(p[0])] || near[at(p[1])]; });
}

}  // namespace

SewnPanels sew_seam(const Scene& scene, const Seam& seam, const std::string& source) {
  Seam sewn_pairs = seam;
  SewnPanels sewn = weld_and_part(scene, sewn_pairs, source);

  // Each attempt leaves out more pairs around what still intersects.
  for (int reach = 1; reach <= kOpenRings && !sewn.left.empty(); ++reach) {
    open_beside(scene.cloths[0].mesh, sewn.left, reach, sewn_pairs);
    if (sewn_pairs.pairs.empty()) break;
    sewn = weld_and_part(scene, sewn_pairs, source);
  }
  sewn.open = seam.pairs.size() - sewn_pairs.pairs.size();
  return sewn;
}

}  // namespace icloth
