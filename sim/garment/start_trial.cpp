#include "sim/garment/start_trial.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "kernels/index.h"
#include "sim/bodies/contract.h"
#include "sim/files/text.h"

namespace icloth {

Scene still_scene(const Scene& scene, std::span<const std::size_t> on, double contraction) {
  Scene still;
  still.parameters = scene.parameters;
  for (const Obstacle& obstacle : scene.obstacles) {
    Obstacle& body = still.obstacles.emplace_back();
    body.name = obstacle.name;
    body.mesh = obstacle.mesh;
    obstacle.pose(0, body.mesh.positions);
    if (contraction > 0) contract(body.mesh.positions, body.mesh.faces, contraction);
  }

  for (std::size_t g : on) {
    Cloth& cloth = still.cloths.emplace_back(scene.cloths[at(scene.garments[g].cloth)]);
    cloth.pins.resize(cloth.mesh.positions.size());
    std::iota(cloth.pins.begin(), cloth.pins.end(), Index{0});
  }
  return still;
}

FixedFaces::FixedFaces(const Scene& still)
    : FixedFaces([&] {
        Soup soup;
        const auto add = [&](const std::string& name, const TriangleMesh& mesh) {
          const auto first = static_cast<Index>(soup.positions.size());
          soup.names.push_back(name);
          soup.first_face.push_back(soup.faces.size());
          soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
          for (const Triangle& f : mesh.faces)
            soup.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
        };
        for (const Obstacle& body : still.obstacles) add("body " + in_quotes(body.name), body.mesh);
        for (const Cloth& cloth : still.cloths) add("cloth " + in_quotes(cloth.name), cloth.mesh);
        return soup;
      }()) {}

FixedFaces::FixedFaces(Soup soup)
    : tree_(soup.positions, soup.faces),
      names_(std::move(soup.names)),
      first_face_(std::move(soup.first_face)) {}

const std::string& FixedFaces::name_of(std::size_t face) const {
  const auto after = std::ranges::upper_bound(first_face_, face);
  return names_[static_cast<std::size_t>(after - first_face_.begin()) - 1];
}

StartTrial::StartTrial(const Scene& scene, std::size_t garment, const FixedFaces& around)
    : garment_(scene.garments[garment]),
      cloth_(scene.cloths[at(garment_.cloth)]),
      around_(around) {}

void StartTrial::place(const std::vector<PanelPlacement>& placements) {
  garment_.placements = placements;
  sew_garment(garment_, cloth_);
}

std::vector<IntersectingFaces> StartTrial::pairs(const std::vector<PanelPlacement>& placements) {
  place(placements);
  ++checks_;
  return find_intersections(cloth_.mesh.positions, cloth_.mesh.faces, around_.tree());
}

std::size_t StartTrial::own_pairs(const std::vector<PanelPlacement>& placements) {
  place(placements);
  const std::span<const int> no_groups;
  return find_intersections(cloth_.mesh.positions, cloth_.mesh.faces, no_groups).size();
}

std::vector<std::size_t> StartTrial::by_panel(std::span<const IntersectingFaces> pairs) const {
  std::vector<std::size_t> count(garment_.placements.size());
  for (const IntersectingFaces& pair : pairs)
    for (Index f : {pair.a, pair.b})
      if (at(f) < cloth_.mesh.faces.size()) ++count[at(garment_.sewn.panel[at(f)])];
  return count;
}

std::vector<std::string> StartTrial::clauses(std::span<const IntersectingFaces> pairs) const {
  // Panels are named before what they meet.
  std::map<std::pair<std::string, std::string>, std::size_t> count;
  for (const IntersectingFaces& pair : pairs) {
    std::string a = name_of(pair.a), b = name_of(pair.b);
    ++count[std::minmax(a, b, [](const std::string& p, const std::string& q) {
      const bool p_is_panel = p.starts_with("panel"), q_is_panel = q.starts_with("panel");
      return p_is_panel != q_is_panel ? p_is_panel : p < q;
    })];
  }

  // Names with their numbers of pairs, from the largest to the smallest.
  std::vector<std::pair<std::size_t, std::string>> sorted;
  for (const auto& [names, pairs_of] : count)
    sorted.emplace_back(pairs_of, names.first + " and " + names.second);
  std::ranges::stable_sort(sorted, std::ranges::greater{}, &decltype(sorted)::value_type::first);

  std::vector<std::string> clauses;
  for (const auto& [pairs_of, text] : sorted)
    clauses.push_back(text + " (" + std::to_string(pairs_of) +
                      (pairs_of == 1 ? " pair of faces)" : " pairs of faces)"));
  return clauses;
}

std::string StartTrial::name_of(Index face) const {
  const std::size_t own = cloth_.mesh.faces.size();
  if (at(face) >= own) return around_.name_of(at(face) - own);
  return "panel " + in_quotes(garment_.sewn.panel_names[at(garment_.sewn.panel[at(face)])]);
}

}  // namespace icloth
