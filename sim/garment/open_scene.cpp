#include "sim/garment/open_scene.h"

#include <algorithm>

#include "kernels/index.h"
#include "sim/files/text.h"
#include "sim/garment/drape_cache.h"
#include "sim/garment/refine.h"
#include "sim/scene/repair.h"

namespace icloth {
namespace {

constexpr std::size_t kMostNamed = 4;  // panels in a note

/// What users should know about how the garment starts.
void note_arrangement(const std::string& cloth, const Arrangement& arrangement,
                      std::vector<std::string>& notes) {
  if (arrangement.raised > 0)
    notes.push_back(cloth + " is raised by " + rounded_text(arrangement.raised) +
                    " m: its pattern, which reaches below the feet, has its origin at the waist");
  if (!arrangement.moved.empty())
    notes.push_back(cloth + ": " + first_items(arrangement.moved, kMostNamed) +
                    "; as the pattern has them, " + std::to_string(arrangement.pairs_before) +
                    " pairs of faces intersect");
  if (arrangement.contraction > 0 && arrangement.pairs_left == 0)
    notes.push_back(cloth + ": bodies start contracted over " +
                    rounded_text(1000 * arrangement.contraction) +
                    " mm and grow back while it is put on");
  if (arrangement.repaired > 0)
    notes.push_back(cloth + ": " + std::to_string(arrangement.repaired) +
                    " of its vertices are moved to part faces that intersect at the start");
  if (arrangement.pairs_left > 0)
    notes.push_back(cloth + " cannot be put on: " + first_items(arrangement.left, kMostNamed) +
                    " intersect at the start");
}

/// Puts the garments on in the triangles that they have. Those that are on are appended to `on`.
std::vector<GarmentReport> put_on(Scene& scene, std::vector<std::size_t>& on,
                                  std::vector<std::string>& notes, const DressingWatch& watch) {
  std::vector<GarmentReport> reports;
  for (std::size_t g : dressing_order(scene)) {
    const std::string& name = scene.cloths[at(scene.garments[g].cloth)].name;
    GarmentReport& report = reports.emplace_back();
    report.garment = name;
    report.arrangement = arrange_garment(scene, g, on);
    note_arrangement("cloth " + in_quotes(name), report.arrangement, notes);
    if (report.arrangement.pairs_left > 0) break;

    if (scene.garments[g].plan.on)
      report.dressing = dress_garment(scene, g, on, report.arrangement.contraction, watch);
    on.push_back(g);
  }
  return reports;
}

/// The reports of the garments that were dressed, if that is all of them; otherwise none.
std::vector<DressingReport*> dressed(std::vector<GarmentReport>& reports, std::size_t garments) {
  std::vector<DressingReport*> found;
  for (GarmentReport& report : reports)
    if (report.dressing) found.push_back(&*report.dressing);
  if (found.size() < garments) found.clear();
  return found;
}

}  // namespace

std::vector<GarmentReport> put_garments_on(Scene& scene, std::vector<std::string>& notes,
                                           const DressingWatch& watch) {
  const int levels = refinements(scene);
  std::vector<std::size_t> on;
  if (levels == 0) return put_on(scene, on, notes, watch);

  // The time goes into the seams that draw together, which few triangles do as well. Those of all
  // garments are divided at once, so that layers which lie on one another stay free.
  Scene worn = coarsest_scene(scene);
  std::vector<GarmentReport> reports = put_on(worn, on, notes, watch);
  const std::vector<DressingReport*> settling = dressed(reports, scene.garments.size());
  for (int level = 0; level < levels; ++level) {
    refine_garments(worn, level);
    if (!settling.empty()) settle_refined(worn, on, settling, watch);
  }
  scene.cloths = std::move(worn.cloths);
  scene.garments = std::move(worn.garments);
  return reports;
}

std::shared_ptr<const Scene> open_scene(const std::string& argument,
                                        std::span<const std::string> overrides, SceneOrigin* origin,
                                        const DressingWatch& watch, const SceneLimits& limits) {
  SceneOrigin own;
  if (!origin) origin = &own;
  std::shared_ptr<const Scene> loaded = load_scene(argument, overrides, limits, origin);
  if (loaded->garments.empty()) return loaded;

  // What was dressed before with the same pattern, body, fabric and parameters is taken as it was.
  auto scene = std::make_shared<Scene>(*loaded);
  const std::string folder = drape_folder(), key = drape_key(*scene);
  std::optional<Drape> drape = load_drape(folder, key, *scene);
  if (drape) {
    for (std::size_t g = 0; g < scene->garments.size(); ++g)
      scene->cloths[at(scene->garments[g].cloth)].mesh.positions = drape->positions[g];
  } else {
    drape.emplace();
    const auto reports = put_garments_on(*scene, drape->notes, watch);
    const bool worn =
        reports.size() == scene->garments.size() && reports.back().arrangement.pairs_left == 0;
    for (const Garment& garment : scene->garments)
      drape->positions.push_back(scene->cloths[at(garment.cloth)].mesh.positions);
    if (worn) save_drape(folder, key, *drape);
  }
  origin->notes.insert(origin->notes.end(), drape->notes.begin(), drape->notes.end());
  if (scene->repair) repair_start(*scene, median_edge(*scene));
  return scene;
}

}  // namespace icloth
