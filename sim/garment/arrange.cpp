#include "sim/garment/arrange.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "kernels/index.h"
#include "sim/bodies/offset.h"
#include "sim/files/box.h"
#include "sim/files/text.h"
#include "sim/scene/intersections.h"

namespace icloth {
namespace {

// What is tried for a panel: radii of bending round the body, nearest to flat first, and ways to
// stand further away from it and higher.
constexpr double kRadii[] = {0, 0.4, 0.25, 0.18, 0.12, 0.08};                 // [m]; 0: flat
constexpr double kDistances[] = {0, 0.02, 0.04, 0.06, 0.08, 0.12, 0.16};      // [m]
constexpr double kLifts[] = {0, 0.02, 0.04, 0.06, 0.08, 0.12, -0.02, -0.04};  // [m]
constexpr double kTilts[] = {0, 15, 30, 45, 60};  // of sleeves and legs downwards [degrees]
constexpr double kDepths[] = {0, 0.01, 0.02, 0.03, 0.04};  // of thinner bodies [m]
constexpr int kMostChecks = 600;
constexpr double kRadians = std::numbers::pi / 180;  // of a degree

/// All that a garment may go through at its start: bodies, and garments that are on already.
struct Surroundings {
  std::vector<Vec3d> positions;
  std::vector<Triangle> faces;
  std::vector<int> group;  ///< −1: body
  std::vector<std::string> names;
  std::vector<std::size_t> first_face;  ///< of each name

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
    if (depth > 0) offset_along_normals(body.positions, body.faces, -depth);
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

  int checks() const { return checks_; }
  const Pattern& pattern() const { return garment_.meshed->pattern; }

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

/// How a panel stands against its place in the pattern.
struct Stand {
  double distance = 0, lift = 0;  ///< [m]
  double tilt = 0;                ///< of a sleeve or leg, its outer end downwards [degrees]
  std::optional<double> radius;   ///< of bending [m], 0: flat; none: the pattern's own
  bool operator==(const Stand&) const = default;
};

/// Turns a panel beside the middle plane about the end of it that is nearer to that plane.
void tilt(const Panel& panel, double degrees, PanelPlacement& place) {
  const Box box = box_around(place_points(panel.corners, place));
  const bool left = box.low.x + box.high.x > 0;
  const Vec3d pivot{left ? box.low.x : box.high.x, 0.5 * (box.low.y + box.high.y), 0};
  const double turn = left ? -degrees : degrees;
  const double c = std::cos(turn * kRadians), s = std::sin(turn * kRadians);
  const Vec3d t = place.translation - pivot;
  place.translation = pivot + Vec3d{c * t.x - s * t.y, s * t.x + c * t.y, t.z};
  place.rotation.z += turn;  // the last of the turns about the axes
}

PanelPlacement placed(const Panel& panel, const Stand& stand) {
  PanelPlacement place = panel.placement;
  if (stand.tilt > 0) tilt(panel, stand.tilt, place);
  place.translation += stand.distance * outside_of(panel) + Vec3d{0, stand.lift, 0};
  if (stand.radius) place.bend_radius = (panel.clockwise ? -1 : 1) * *stand.radius;
  return place;
}

/// Panels that move together: one panel, a panel and its mirror image, those of the trunk, or all.
struct PanelGroup {
  std::vector<std::size_t> panels;
  bool limb = false;  ///< beside the middle plane: it may be tilted
};

/// Each panel with the one that stands where its mirror image does, left and right exchanged, and
/// the panels of the trunk and of the limbs.
std::vector<PanelGroup> panel_groups(const Pattern& pattern) {
  constexpr double kTolerance = 0.005;  // [m]
  std::vector<Box> boxes;
  for (const Panel& panel : pattern.panels)
    boxes.push_back(box_around(place_points(panel.corners, panel.placement)));
  const auto is_mirror = [&](const Box& a, const Box& b) {
    const Vec3d low{-b.high.x, b.low.y, b.low.z}, high{-b.low.x, b.high.y, b.high.z};
    return norm(a.low - low) < kTolerance && norm(a.high - high) < kTolerance;
  };

  const auto is_limb = [&](std::size_t p) {
    return boxes[p].low.x > kTolerance || boxes[p].high.x < -kTolerance;
  };

  std::vector<PanelGroup> groups;
  std::vector<bool> taken(boxes.size());
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    if (taken[p]) continue;
    PanelGroup group{{p}, is_limb(p)};
    for (std::size_t q = p + 1; q < boxes.size() && group.panels.size() == 1; ++q)
      if (!taken[q] && is_mirror(boxes[p], boxes[q])) group.panels.push_back(q);
    for (std::size_t q : group.panels) taken[q] = true;
    groups.push_back(std::move(group));
  }

  // What goes round the trunk moves together as well, and so do the sleeves or legs beside it.
  PanelGroup trunk, limbs;
  limbs.limb = true;
  for (std::size_t p = 0; p < boxes.size(); ++p) (is_limb(p) ? limbs : trunk).panels.push_back(p);
  for (PanelGroup* group : {&trunk, &limbs})
    if (group->panels.size() > 1 && group->panels.size() < boxes.size())
      groups.push_back(std::move(*group));
  return groups;
}

/// Searches for stands of all panels with as few intersecting pairs as possible.
class StandSearch {
 public:
  StandSearch(Trial& trial, std::vector<Stand>& stands, int most_checks)
      : trial_(trial), panels_(trial.pattern().panels), stands_(stands), most_checks_(most_checks) {
    left_ = trial_.pairs(placements(stands_));
  }

  /// Moves all panels at once, then group after group, those in most pairs first, one quantity at a
  /// time, and keeps what leaves fewer pairs, until nothing does.
  const std::vector<IntersectingFaces>& run() {
    PanelGroup all{std::vector<std::size_t>(panels_.size()), false};
    std::iota(all.panels.begin(), all.panels.end(), std::size_t{0});
    const std::vector<PanelGroup> groups = panel_groups(trial_.pattern());
    try_all_together(all);
    for (std::size_t before = left_.size() + 1; before > left_.size() && !left_.empty();) {
      before = left_.size();
      for (const PanelGroup& group : by_pairs(groups)) try_moves(group);
    }
    return left_;
  }

  /// Pairs that the best stands so far leave.
  const std::vector<IntersectingFaces>& left() const { return left_; }

  std::vector<PanelPlacement> placements(const std::vector<Stand>& stands) const {
    std::vector<PanelPlacement> result;
    for (std::size_t p = 0; p < panels_.size(); ++p)
      result.push_back(placed(panels_[p], stands[p]));
    return result;
  }

 private:
  std::vector<PanelGroup> by_pairs(std::vector<PanelGroup> groups) const {
    const std::vector<std::size_t> count = trial_.by_panel(left_);
    const auto pairs_of = [&](const PanelGroup& group) {
      std::size_t sum = 0;
      for (std::size_t p : group.panels) sum += count[p];
      return sum;
    };
    std::erase_if(groups, [&](const PanelGroup& group) { return pairs_of(group) == 0; });
    std::ranges::stable_sort(groups, std::ranges::greater{}, pairs_of);
    return groups;
  }

  /// Lifts and spreads the garment as a whole: a better place for it may lie beyond worse ones.
  void try_all_together(const PanelGroup& all) {
    const std::vector<Stand> before = stands_;
    for (double lift : kLifts)
      for (double distance : kDistances)
        try_change(before, all, [&](Stand& s) {
          s.lift = lift;
          s.distance = distance;
        });
  }

  /// Takes the best one of the moves of a group, if it leaves fewer pairs.
  void try_moves(const PanelGroup& group) {
    const std::vector<Stand> before = stands_;
    for (double lift : kLifts) try_change(before, group, [&](Stand& s) { s.lift = lift; });
    for (double distance : kDistances)
      try_change(before, group, [&](Stand& s) { s.distance = distance; });
    if (group.limb)
      for (double tilt : kTilts) try_change(before, group, [&](Stand& s) { s.tilt = tilt; });
    for (double radius : kRadii) try_change(before, group, [&](Stand& s) { s.radius = radius; });
    try_change(before, group, [](Stand& s) { s.radius.reset(); });
  }

  template <class Change>
  void try_change(const std::vector<Stand>& before, const PanelGroup& group, const Change& change) {
    std::vector<Stand> stands = before;
    for (std::size_t p : group.panels) change(stands[p]);
    if (left_.empty() || stands == before || checks_ >= most_checks_) return;
    ++checks_;
    std::vector<IntersectingFaces> pairs = trial_.pairs(placements(stands));
    if (pairs.size() >= left_.size()) return;
    left_ = std::move(pairs);
    stands_ = std::move(stands);
  }

  Trial& trial_;
  const std::vector<Panel>& panels_;
  std::vector<Stand>& stands_;
  std::vector<IntersectingFaces> left_;
  int most_checks_, checks_ = 0;
};

/// Patterns of one family are placed round a body whose origin is at its waist instead of between
/// its feet: such a garment reaches far below the ground that the wearer stands on. It is raised by
/// the height of that origin, and by how much is returned [m].
double lift_to_body(Scene& scene, std::size_t number) {
  constexpr double kBelowFeet = 0.05;     // [m]
  constexpr double kOriginHeight = 0.69;  // of the average woman's body, over her height
  Garment& garment = scene.garments[number];
  Cloth& cloth = scene.cloths[at(garment.cloth)];

  // The wearer is the obstacle that the scene names, or the tallest one.
  Box wearer;
  std::vector<Vec3d> pose;
  for (const Obstacle& obstacle : scene.obstacles) {
    if (!garment.body.empty() && obstacle.name != garment.body) continue;
    obstacle.pose(0, pose);
    const Box box = box_around(pose);
    if (wearer.empty() || box.size().y > wearer.size().y) wearer = box;
  }
  const Box cover = box_around(cloth.mesh.positions);
  if (wearer.empty() || cover.low.y > wearer.low.y - kBelowFeet) return 0;

  const double height = kOriginHeight * wearer.size().y;
  garment.translation.y += height;
  sew_garment(garment, cloth);
  return height;
}

/// "panel 'front' stands 4 cm further out, 2 cm higher and is flat", for each that moved.
std::vector<std::string> moved_panels(const Pattern& pattern, std::span<const Stand> stands) {
  std::vector<std::string> moved;
  for (std::size_t p = 0; p < stands.size(); ++p) {
    const Stand& stand = stands[p];
    std::vector<std::string> parts;

    // What differs from the pattern, each in words.
    if (stand.distance > 0) parts.push_back(rounded_text(100 * stand.distance) + " cm further out");
    if (stand.lift != 0)
      parts.push_back(rounded_text(100 * std::fabs(stand.lift)) + " cm " +
                      (stand.lift > 0 ? "higher" : "lower"));
    if (stand.tilt > 0) parts.push_back("tilted by " + rounded_text(stand.tilt) + "°");
    if (stand.radius)
      parts.push_back(*stand.radius == 0 ? "flat"
                                         : "bent to " + rounded_text(100 * *stand.radius) + " cm");
    if (parts.empty()) continue;

    // The parts become one clause about the panel.
    std::string clause = "panel " + in_quotes(pattern.panels[p].name) + " is ";
    for (std::size_t i = 0; i < parts.size(); ++i)
      clause += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    moved.push_back(clause);
  }
  return moved;
}

}  // namespace

Arrangement arrange_garment(Scene& scene, std::size_t number, std::span<const std::size_t> on) {
  Garment& garment = scene.garments[number];
  const Pattern& pattern = garment.meshed->pattern;
  Arrangement result;
  result.raised = lift_to_body(scene, number);
  std::vector<Stand> best(pattern.panels.size());

  // What still goes through the body may start outside a thinner one, which then grows back.
  for (double depth : kDepths) {
    Trial trial(scene, number, surroundings_of(scene, on, depth));
    std::vector<Stand> stands = best;
    StandSearch search(trial, stands, kMostChecks);
    if (depth == 0) result.pairs_before = search.left().size();
    const std::vector<IntersectingFaces>& left = search.run();
    result.checks += trial.checks();
    if (depth == 0) result.pairs_moved = left.size();
    if (depth == 0 || left.size() < result.pairs_left) {
      best = stands;
      result.pairs_left = left.size();
      result.shrink = depth;
      trial.pairs(search.placements(best));
      result.left = trial.clauses(left);
    }
    if (left.empty()) break;
  }

  for (std::size_t p = 0; p < best.size(); ++p)
    garment.placements[p] = placed(pattern.panels[p], best[p]);
  sew_garment(garment, scene.cloths[at(garment.cloth)]);
  result.moved = moved_panels(pattern, best);
  return result;
}

}  // namespace icloth
