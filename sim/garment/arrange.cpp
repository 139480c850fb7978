#include "sim/garment/arrange.h"

#include <algorithm>
#include <span>

#include "kernels/index.h"
#include "sim/files/box.h"
#include "sim/garment/stands.h"
#include "sim/garment/start_trial.h"
#include "sim/scene/repair.h"

namespace icloth {
namespace {

// What is tried for a panel: radii of bending round the body, nearest to flat first, and ways to
// stand further away from it, higher or lower.
constexpr double kRadii[] = {0, 0.4, 0.25, 0.18, 0.12, 0.08};  // [m]; 0: flat
constexpr double kDistances[] = {0, 0.04, 0.08, 0.12, 0.16};   // [m]
constexpr double kLifts[] = {0,     0.02,  0.04,  0.08, 0.12, -0.02,
                             -0.04, -0.06, -0.08, -0.1, -0.12};  // [m]
constexpr double kSpreads[] = {0, 0.04, 0.08};                   // of sleeves and legs [m]
constexpr double kTilts[] = {0, 15, 30, 45, 60};  // of sleeves and legs downwards [degrees]
constexpr double kContractions[] = {0, 0.02, 0.04, 0.08, 0.16};  // of bodies [m]
constexpr std::size_t kMostRepaired = 100;                       // pairs of faces
constexpr int kMostChecks = 1000;                                // at one contraction

/// Searches for stands of all panels with as few intersecting pairs as possible.
class StandSearch {
 public:
  /// Begins where the pattern has the panels.
  StandSearch(StartTrial& trial, const PanelStands& panels)
      : trial_(trial), panels_(panels), stands_(panels.size()) {
    left_ = trial_.pairs(panels_.placed(stands_));
  }

  /// Lifts and spreads the garment as a whole while its sleeves hang lower, and takes the best of
  /// all combinations.
  void move_together() {
    const auto stands_with = [&](double tilt, double spread, double distance, double lift) {
      std::vector<Stand> stands(panels_.size());
      for (std::size_t p = 0; p < stands.size(); ++p) {
        const bool limb = panels_.is_limb(p);
        stands[p] = {distance, lift, limb ? spread : 0, limb ? tilt : 0, {}};
      }
      return stands;
    };

    for (double tilt : kTilts)
      for (double spread : kSpreads)
        for (double distance : kDistances) {
          if (left_.empty() || (tilt + spread > 0 && !panels_.has_limbs())) return;
          // Lifting does not part panels that go through each other.
          const auto placements = panels_.placed(stands_with(tilt, spread, distance, 0));
          if (trial_.own_pairs(placements) >= left_.size()) continue;
          for (double lift : kLifts) try_stands(stands_with(tilt, spread, distance, lift));
        }
  }

  /// Moves group after group, those in most pairs first, one quantity at a time, and keeps what
  /// leaves fewer pairs, until nothing does.
  void move_apart() {
    const std::vector<PanelGroup> groups = panels_.groups();
    for (std::size_t before = left_.size() + 1; before > left_.size() && !left_.empty();) {
      before = left_.size();
      for (const PanelGroup& group : by_pairs(groups)) try_moves(group);
    }
  }

  /// The best stands so far, and the pairs that they leave.
  const std::vector<Stand>& stands() const { return stands_; }
  const std::vector<IntersectingFaces>& left() const { return left_; }

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

  /// Takes the best one of the moves of a group, if it leaves fewer pairs.
  void try_moves(const PanelGroup& group) {
    const std::vector<Stand> before = stands_;
    const auto try_all = [&](const auto& values, const auto& set) {
      for (double value : values) try_change(before, group, [&](Stand& s) { set(s, value); });
    };
    try_all(kLifts, [](Stand& s, double value) { s.lift = value; });
    try_all(kDistances, [](Stand& s, double value) { s.distance = value; });
    if (group.limb) try_all(kSpreads, [](Stand& s, double value) { s.spread = value; });
    if (group.limb) try_all(kTilts, [](Stand& s, double value) { s.tilt = value; });
    try_all(kRadii, [](Stand& s, double value) { s.radius = value; });
    try_change(before, group, [](Stand& s) { s.radius.reset(); });
  }

  template <class Change>
  void try_change(std::vector<Stand> stands, const PanelGroup& group, const Change& change) {
    for (std::size_t p : group.panels) change(stands[p]);
    try_stands(stands);
  }

  void try_stands(const std::vector<Stand>& stands) {
    if (left_.empty() || stands == stands_ || trial_.checks() >= kMostChecks) return;
    std::vector<IntersectingFaces> pairs = trial_.pairs(panels_.placed(stands));
    if (pairs.size() >= left_.size()) return;
    left_ = std::move(pairs);
    stands_ = stands;
  }

  StartTrial& trial_;
  const PanelStands& panels_;
  std::vector<Stand> stands_;
  std::vector<IntersectingFaces> left_;
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

/// The best start that was found for a garment.
class BestStart {
 public:
  BestStart(Scene& scene, std::size_t garment, std::span<const std::size_t> on)
      : scene_(scene), number_(garment), on_(on), panels_(*scene.garments[garment].meshed) {}

  /// Moves panels among bodies that are contracted so far [m]: all of them together, or also each
  /// group of its own (`apart`).
  void search(double contraction, bool apart) {
    // Where a body is hollow its contraction fills it, which may reach a garment that is on.
    const Scene still = still_scene(scene_, on_, contraction);
    if (contraction > 0 && !find_start_intersections(still, true).empty()) return;
    const FixedFaces around(still);
    StartTrial trial(scene_, number_, around);
    StandSearch search(trial, panels_);
    if (result_.checks == 0) result_.pairs_before = search.left().size();
    search.move_together();
    if (apart) search.move_apart();

    if (result_.checks == 0 || search.left().size() < result_.pairs_left) {
      stands_ = search.stands();
      result_.pairs_left = search.left().size();
      result_.contraction = contraction;
      trial.pairs(panels_.placed(stands_));
      result_.left = trial.clauses(search.left());
    }
    if (contraction == 0 && !apart) result_.pairs_moved = result_.pairs_left;
    result_.checks += trial.checks();
  }

  /// Parts what still crosses in the best start, vertex by vertex, if that is little.
  void repair() {
    if (result_.pairs_left > kMostRepaired) return;
    Scene start = still_scene(scene_, on_, result_.contraction);
    Garment garment = scene_.garments[number_];
    garment.placements = panels_.placed(stands_);
    start.cloths.push_back(scene_.cloths[at(garment.cloth)]);
    sew_garment(garment, start.cloths.back());

    const StartRepair repair = repair_start(start, garment.meshed->edge_length);
    if (repair.pairs_left > 0) return;
    repaired_ = start.cloths.back().mesh.positions;
    result_.pairs_left = 0;
    result_.repaired = repair.moved;
  }

  bool is_clean() const { return result_.checks > 0 && result_.pairs_left == 0; }

  /// Leaves the garment there.
  Arrangement take() {
    Garment& garment = scene_.garments[number_];
    garment.placements = panels_.placed(stands_);
    sew_garment(garment, scene_.cloths[at(garment.cloth)]);
    if (!repaired_.empty()) scene_.cloths[at(garment.cloth)].mesh.positions = repaired_;
    result_.moved = panels_.in_words(stands_);
    return result_;
  }

 private:
  Scene& scene_;
  std::size_t number_;
  std::span<const std::size_t> on_;
  PanelStands panels_;
  std::vector<Stand> stands_;
  std::vector<Vec3d> repaired_;  ///< positions of the garment, where it was repaired
  Arrangement result_;
};

}  // namespace

Arrangement arrange_garment(Scene& scene, std::size_t number, std::span<const std::size_t> on) {
  const double raised = lift_to_body(scene, number);
  BestStart best(scene, number, on);

  // What still goes through the body may start outside a slender one, which then grows back. A
  // garment that moves as a whole keeps its shape and closes neatly, so that is tried first.
  for (const bool apart : {false, true}) {
    for (double contraction : kContractions)
      if (!best.is_clean()) best.search(contraction, apart);
    if (!best.is_clean()) best.repair();
  }

  Arrangement result = best.take();
  result.raised = raised;
  return result;
}

}  // namespace icloth
