#include "sim/scene/repair.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "sim/scene/intersections.h"
#include "sim/scene/repair_clusters.h"
#include "sim/scene/repair_hulls.h"
#include "sim/scene/repair_moves.h"
#include "sim/scene/repair_seams.h"

namespace icloth {
namespace {

constexpr int kMostCycles = 3;   ///< over all methods
constexpr int kMostRounds = 4;   ///< looks for contours, in one attempt
constexpr int kMostPasses = 12;  ///< moves, each with the constraints of the positions before
constexpr int kPatience = 3;     ///< passes without much less that is missing

/// Limit of the work, counted in constraints that are looked at: about 10 s for 10,000 faces.
constexpr std::int64_t kWorkOfFace = 40'000, kLeastWork = 20'000'000;
constexpr std::int64_t kWorkOfConstraint = 30;  ///< to find one
constexpr std::int64_t kWorkOfPass = 100;       ///< a face, to look for them

/// How the surfaces on both sides of a contour are told to part.
enum class Method {
  sides,  ///< one above the other, or beside each other at borders
  hulls,  ///< the faces along a contour as two bodies
  pairs   ///< each pair of faces alone
};

std::vector<Contour> contours_of(const RepairMesh& mesh, std::span<const IntersectingFaces> pairs,
                                 Method method) {
  std::vector<Contour> contours = trace_contours(mesh, pairs);
  return method == Method::pairs ? split_into_pairs(contours) : contours;
}

std::vector<Side> choose(const RepairMesh& mesh, std::span<const Contour> contours, double limit,
                         Method method) {
  if (method != Method::sides) return choose_hulls(mesh, contours, limit);
  std::vector<Side> sides = choose_sides(mesh, contours, limit);
  choose_seams(mesh, contours, 0.25 * limit, sides);
  return sides;
}

/// Adds contours that are not yet among those found before. Returns whether one of them tells
/// vertices to move.
bool add_contours(std::vector<Contour> contours, std::vector<Side> sides,
                  std::vector<SidedContour>& known) {
  // A contour that shares segments with a known one is a rest of it, and has its side already.
  std::vector<std::pair<Index, Index>> seen;
  for (const SidedContour& old : known)
    for (const Contour::Segment& s : old.contour.segments) seen.emplace_back(s.own, s.other);
  std::ranges::sort(seen);
  const auto is_known = [&](const Contour::Segment& s) {
    return std::ranges::binary_search(seen, std::pair{s.own, s.other});
  };

  bool added = false;
  const std::size_t first = known.size();
  for (std::size_t c = 0; c < contours.size(); ++c) {
    if (std::ranges::any_of(contours[c].segments, is_known)) sides[c] = {};
    added = added || sides[c].decided();
    contours[c].twin += first;
    known.push_back({std::move(contours[c]), std::move(sides[c])});
  }
  return added;
}

double deepest(std::span<const SidedContour> contours) {
  double depth = 0;
  for (const SidedContour& c : contours) depth = std::max(depth, c.side.depth);
  return depth;
}

std::int64_t work_limit(const RepairMesh& mesh, double share) {
  const auto faces = static_cast<std::int64_t>(mesh.faces.size());
  return static_cast<std::int64_t>(share *
                                   static_cast<double>(std::max(kLeastWork, kWorkOfFace * faces)));
}

/// The repair of one scene: mesh_.x and pairs_ are the best that has been found so far.
class Repair {
 public:
  Repair(const Scene& scene, double limit, double work)
      : mesh_(scene),
        offset_(scene.parameters.impact_zones.offset),
        limit_(limit),
        work_(work_limit(mesh_, work)),
        pairs_(find_intersections(mesh_)) {}

  std::size_t pairs_left() const { return pairs_.size(); }
  const RepairMesh& mesh() const { return mesh_; }

  void run() {
    if (pairs_.empty()) return;

    // What one method leaves may be easy for another one.
    for (int cycle = 0; cycle < kMostCycles && !pairs_.empty(); ++cycle) {
      const std::size_t before = pairs_.size();
      attempt(Method::sides, limit_);
      const double shallow = (cycle == 0 ? 0.05 : 0.25) * limit_;
      attempt(Method::hulls, shallow);
      attempt(Method::pairs, shallow);
      if (pairs_.size() == before && cycle > 0) break;
    }
    if (pairs_.empty()) make_room();
  }

 private:
  /// Moves from the best positions, and keeps what pays.
  void attempt(Method method, double depth_limit) {
    const std::int64_t reserve = work_ / 2;  // for the attempts that follow
    work_ -= reserve;
    mesh_.base = mesh_.x;
    std::vector<Vec3d> reached = mesh_.x;
    std::vector<IntersectingFaces> present = pairs_;

    // Contours that appear because of the moves are taken up in the next round. Such ones must not
    // lead deeper than what the moves were made for.
    std::vector<SidedContour> contours;
    for (int round = 0; round < kMostRounds && !present.empty() && work_ > 0; ++round) {
      const std::vector<Vec3d> best = std::exchange(mesh_.x, std::move(reached));
      std::vector<Contour> found = contours_of(mesh_, present, method);
      std::vector<Side> sides = choose(mesh_, found, depth_limit, method);
      if (!add_contours(std::move(found), std::move(sides), contours)) {
        mesh_.x = best;
        break;
      }
      if (round == 0) depth_limit = std::min(depth_limit, 2 * deepest(contours));

      // Faces that part as bodies are few, so nothing has to go far to make room for them.
      const double move_limit =
          method == Method::sides ? limit_ : std::min(limit_, depth_limit + 3 * offset_);
      const auto constraints = move_apart(contours, move_limit, false);
      present = find_intersections(mesh_);
      reached = mesh_.x;
      pairs_ = keep_what_pays(mesh_, {best, pairs_, constraints, limit_, false});
    }
    work_ += reserve;

    // The views of a contour stay together in the longer list.
    const std::size_t first = touched_.size();
    for (SidedContour& c : contours) {
      c.contour.twin += first;
      touched_.push_back(std::move(c));
    }
  }

  /// Room for the first step. The shortest moves are looked for once more, now that every element
  /// is on its side; where they lead back into a crossing, from where the elements are.
  void make_room() {
    for (const bool from_start : {true, false}) {
      mesh_.base = from_start ? mesh_.start : mesh_.x;
      const std::vector<Vec3d> best = mesh_.x;
      const std::vector<GapConstraint> constraints = move_apart(touched_, limit_, true);
      pairs_ = keep_what_pays(mesh_, {best, {}, constraints, limit_, true});
    }
  }

  /// Moves vertices until all constraints hold at the positions to which they lead. Returns the
  /// last constraints.
  std::vector<GapConstraint> move_apart(std::span<const SidedContour> contours, double limit,
                                        bool parted) {
    double least = std::numeric_limits<double>::infinity();
    int waited = 0;
    std::vector<GapConstraint> constraints;
    for (int pass = 0; pass < kMostPasses && waited < kPatience && work_ > 0; ++pass) {
      constraints = collect_constraints(mesh_, contours, offset_, parted);
      work_ -= kWorkOfConstraint * static_cast<std::int64_t>(constraints.size()) +
               kWorkOfPass * static_cast<std::int64_t>(mesh_.faces.size());
      double missing = 0;
      for (const GapConstraint& c : constraints)
        missing = std::max(missing, c.target - gap_of(mesh_, c));

      // The whole offset counts once nothing crosses any more.
      if (missing < (parted ? 0.05 : 0.3) * offset_) break;
      waited = missing < 0.8 * least ? 0 : waited + 1;
      least = std::min(least, missing);
      move_vertices(mesh_, constraints, limit, std::max(0.01 * offset_, 0.02 * missing), work_);
    }
    return constraints;
  }

  RepairMesh mesh_;
  double offset_, limit_;
  std::int64_t work_;
  std::vector<IntersectingFaces> pairs_;
  std::vector<SidedContour> touched_;  ///< contours of all attempts
};

}  // namespace

StartRepair repair_start(Scene& scene, double limit, double work) {
  Repair repair(scene, limit, work);
  StartRepair result;
  result.pairs_before = repair.pairs_left();
  repair.run();
  result.pairs_left = repair.pairs_left();

  // Vertices that were not moved keep their digits.
  std::size_t next = 0;
  for (Cloth& cloth : scene.cloths)
    for (Vec3d& p : cloth.mesh.positions) {
      const Vec3d from = repair.mesh().start[next], to = repair.mesh().x[next++];
      if (from == to) continue;
      ++result.moved;
      result.largest_move = std::max(result.largest_move, norm(to - from));
      p = to;
    }
  scene.repair = result;
  return result;
}

}  // namespace icloth
