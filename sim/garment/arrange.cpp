#include "sim/garment/arrange.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "kernels/index.h"
#include "sim/files/text.h"
#include "sim/scene/intersections.h"

namespace icloth {
namespace {

// What is tried for a panel: radii of bending round the body, nearest to flat first, and ways to
// stand further away from it.
constexpr double kRadii[] = {0, 0.4, 0.25, 0.18, 0.12, 0.08};  // [m]; 0: flat
constexpr double kDistances[] = {0, 0.02, 0.04, 0.06, 0.08};   // [m]
constexpr double kDepths[] = {0.01, 0.02, 0.03, 0.04};         // of thinner bodies [m]
constexpr int kMostChecks = 150;

/// All that a garment may go through at its start: bodies, and garments that are on already.
struct Surroundings {
  std::vector<Vec3d> positions;
  std::vector<Triangle> faces;
  std::vector<int> group;  ///< −1: body
  std::vector<std::string> names;
  std::vector<std::size_t> first_face;  ///< of each name
  std::vector<TriangleMesh> bodies;     ///< at time 0

  void add(const std::string& name, std::span<const Vec3d> x, std::span<const Triangle> t,
           int number) {
    const auto first = static_cast<Index>(positions.size());
    names.push_back(name);
    first_face.push_back(faces.size());
    positions.insert(positions.end(), x.begin(), x.end());
    for (const Triangle& f : t) faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    group.resize(faces.size(), number);
  }

  const std::string& name_of(std::size_t face) const {
    const auto after = std::ranges::upper_bound(first_face, face);
    return names[static_cast<std::size_t>(after - first_face.begin()) - 1];
  }
};

Surroundings surroundings_of(const Scene& scene, std::span<const std::size_t> on, double depth) {
  Surroundings all;
  for (const Obstacle& obstacle : scene.obstacles) {
    TriangleMesh body = obstacle.mesh;
    obstacle.pose(0, body.positions);
    if (depth > 0) body.positions = shrunk(body, depth);
    all.add("body " + in_quotes(obstacle.name), body.positions, body.faces, -1);
  }
  int number = 1;
  for (std::size_t g : on) {
    const Cloth& cloth = scene.cloths[at(scene.garments[g].cloth)];
    all.add("cloth " + in_quotes(cloth.name), cloth.mesh.positions, cloth.mesh.faces, number++);
  }
  return all;
}

/// One garment with its panels where they are tried.
class Trial {
 public:
  Trial(const Scene& scene, std::size_t garment, Surroundings around)
      : garment_(scene.garments[garment]),
        cloth_(scene.cloths[at(garment_.cloth)]),
        around_(std::move(around)) {}

  /// Pairs of faces that intersect where one of them is the garment's, with these placements.
  std::vector<IntersectingFaces> pairs(const std::vector<PanelPlacement>& placements) {
    garment_.placements = placements;
    sew_garment(garment_, cloth_);
    ++checks_;

    // The faces of the garment come first, so its pairs are those with a small first number.
    std::vector<Vec3d> x = cloth_.mesh.positions;
    std::vector<Triangle> faces = cloth_.mesh.faces;
    std::vector<int> group(faces.size(), 0);
    const auto first = static_cast<Index>(x.size());
    x.insert(x.end(), around_.positions.begin(), around_.positions.end());
    for (const Triangle& t : around_.faces)
      faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    group.insert(group.end(), around_.group.begin(), around_.group.end());

    std::vector<IntersectingFaces> found = find_intersections(x, faces, group);
    const auto own = static_cast<Index>(cloth_.mesh.faces.size());
    std::erase_if(found, [&](const IntersectingFaces& pair) { return pair.a >= own; });
    return found;
  }

  /// How many pairs each panel takes part in.
  std::vector<std::size_t> by_panel(std::span<const IntersectingFaces> pairs) const {
    std::vector<std::size_t> count(garment_.placements.size());
    for (const IntersectingFaces& pair : pairs)
      for (Index f : {pair.a, pair.b})
        if (at(f) < cloth_.mesh.faces.size()) ++count[at(garment_.sewn.panel[at(f)])];
    return count;
  }

  /// The pairs in words, the most frequent first.
  std::vector<std::string> clauses(std::span<const IntersectingFaces> pairs) const {
    std::map<std::pair<std::string, std::string>, std::size_t> count;
    for (const IntersectingFaces& pair : pairs) {
      std::string a = name_of(pair.a), b = name_of(pair.b);
      ++count[std::minmax(a, b, [](const std::string& p, const std::string& q) {
        const bool p_is_panel = p.starts_with("panel"), q_is_panel = q.starts_with("panel");
        return p_is_panel != q_is_panel ? p_is_panel : p < q;
      })];
    }
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

  int checks() const { return checks_; }
  Garment& garment() { return garment_; }
  Cloth& cloth() { return cloth_; }

 private:
  std::string name_of(Index face) const {
    const std::size_t own = cloth_.mesh.faces.size();
    if (at(face) >= own) return around_.name_of(at(face) - own);
    return "panel " + in_quotes(garment_.sewn.panel_names[at(garment_.sewn.panel[at(face)])]);
  }

  Garment garment_;
  Cloth cloth_;
  Surroundings around_;
  int checks_ = 0;
};

/// Outside of a panel in space, where its right side faces.
Vec3d outside_of(const Panel& panel) {
  PanelPlacement turn = panel.placement;
  turn.translation = {};
  turn.bend_radius = 0;
  const Vec2d corners[] = {{0, 0}, {1, 0}, {0, 1}};
  const std::vector<Vec3d> x = place_points(corners, turn);
  const Vec3d normal = cross(x[1] - x[0], x[2] - x[0]);
  return panel.clockwise ? -1.0 * normal : normal;
}

/// Placements of one panel that are tried, those nearest to the pattern's own first.
std::vector<PanelPlacement> choices_for(const Panel& panel) {
  std::vector<PanelPlacement> choices;
  const Vec3d outside = outside_of(panel);
  for (double distance : kDistances)
    for (int r = -1; r < static_cast<int>(std::size(kRadii)); ++r) {
      PanelPlacement choice = panel.placement;
      choice.translation += distance * outside;
      if (r >= 0) choice.bend_radius = (panel.clockwise ? -1 : 1) * kRadii[r];
      choices.push_back(choice);
    }
  return choices;
}

/// Bends and moves panel after panel, those in most pairs first, and keeps what leaves fewer pairs.
std::vector<IntersectingFaces> move_panels(Trial& trial, std::vector<PanelPlacement>& best,
                                           std::vector<IntersectingFaces> left) {
  const std::vector<Panel>& panels = trial.garment().meshed->pattern.panels;
  bool better = true;
  while (better && !left.empty() && trial.checks() < kMostChecks) {
    better = false;
    const std::vector<std::size_t> count = trial.by_panel(left);
    std::vector<std::size_t> order;
    for (std::size_t p = 0; p < panels.size(); ++p)
      if (count[p] > 0) order.push_back(p);
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](std::size_t p) { return count[p]; });

    for (std::size_t p : order)
      for (const PanelPlacement& choice : choices_for(panels[p])) {
        if (left.empty() || trial.checks() >= kMostChecks) break;
        std::vector<PanelPlacement> placements = best;
        placements[p] = choice;
        std::vector<IntersectingFaces> pairs = trial.pairs(placements);
        if (pairs.size() >= left.size()) continue;
        left = std::move(pairs);
        best = std::move(placements);
        better = true;
      }
  }
  return left;
}

std::vector<std::string> moved_panels(const Pattern& pattern,
                                      std::span<const PanelPlacement> placements) {
  std::vector<std::string> moved;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const PanelPlacement& own = pattern.panels[p].placement;
    const double distance = norm(placements[p].translation - own.translation);
    const bool is_bent = placements[p].bend_radius != own.bend_radius;
    if (distance == 0 && !is_bent) continue;
    std::string clause = "panel " + in_quotes(pattern.panels[p].name);
    if (distance > 0) clause += " stands " + rounded_text(100 * distance) + " cm further out";
    if (is_bent) {
      const double radius = std::fabs(placements[p].bend_radius);
      clause += distance > 0 ? " and" : "";
      clause += radius == 0 ? " is flat" : " is bent to " + rounded_text(100 * radius) + " cm";
    }
    moved.push_back(clause);
  }
  return moved;
}

}  // namespace

std::vector<Vec3d> shrunk(const TriangleMesh& mesh, double depth) {
  std::vector<Vec3d> normal(mesh.positions.size());
  for (const Triangle& t : mesh.faces) {
    const Vec3d n = cross(mesh.positions[at(t[1])] - mesh.positions[at(t[0])],
                          mesh.positions[at(t[2])] - mesh.positions[at(t[0])]);
    for (Index v : t) normal[at(v)] += n;
  }
  std::vector<Vec3d> moved = mesh.positions;
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (norm(normal[v]) > 0) moved[v] += -depth * normalized(normal[v]);
  return moved;
}

Arrangement arrange_garment(Scene& scene, std::size_t number, std::span<const std::size_t> on) {
  Garment& garment = scene.garments[number];
  Trial trial(scene, number, surroundings_of(scene, on, 0));
  std::vector<PanelPlacement> placements = garment.placements;
  std::vector<IntersectingFaces> left = trial.pairs(placements);

  Arrangement result;
  result.pairs_before = left.size();
  if (!left.empty()) left = move_panels(trial, placements, std::move(left));
  result.pairs_moved = left.size();
  trial.pairs(placements);
  result.left = trial.clauses(left);
  result.checks = trial.checks();

  // What still goes through the body may start outside a thinner one, which then grows back.
  for (double depth : kDepths) {
    if (left.empty()) break;
    Trial thinner(scene, number, surroundings_of(scene, on, depth));
    const std::vector<IntersectingFaces> pairs = thinner.pairs(placements);
    ++result.checks;
    if (pairs.size() >= left.size()) continue;
    left = pairs;
    result.shrink = depth;
    result.left = thinner.clauses(left);
  }
  result.pairs_left = left.size();

  garment.placements = placements;
  sew_garment(garment, scene.cloths[at(garment.cloth)]);
  result.moved = moved_panels(garment.meshed->pattern, placements);
  return result;
}

}  // namespace icloth
