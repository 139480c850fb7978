#include "sim/scene/repair.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "sim/scene/intersections.h"
#include "sim/scene/repair_moves.h"

namespace icloth {
namespace {

constexpr int kMostRounds = 4;   ///< looks for contours
constexpr int kPatience = 3;     ///< passes without much less that is missing
constexpr int kMostPasses = 12;  ///< moves, each with the constraints of the positions before

std::vector<IntersectingFaces> intersections(const RepairMesh& mesh) {
  return find_intersections(mesh.x, mesh.faces, mesh.group);
}

/// Adds the contours of the present positions that are not yet among those found before.
bool add_contours(const RepairMesh& mesh, std::span<const IntersectingFaces> pairs, double limit,
                  std::vector<SidedContour>& known) {
  std::vector<Contour> contours = trace_contours(mesh, pairs);
  std::vector<Side> sides = choose_sides(mesh, contours, limit);

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
    const bool old = std::ranges::any_of(contours[c].segments, is_known);
    if (old) sides[c] = {};
    added = added || sides[c].sign != 0;
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

/// Moves vertices until all constraints hold at the positions to which they lead.
void move_apart(RepairMesh& mesh, std::span<const SidedContour> contours, double offset,
                double limit, bool parted) {
  double least = std::numeric_limits<double>::infinity();
  int waited = 0;
  for (int pass = 0; pass < kMostPasses && waited < kPatience; ++pass) {
    const std::vector<GapConstraint> constraints =
        collect_constraints(mesh, contours, offset, parted);
    double missing = 0;
    for (const GapConstraint& c : constraints)
      missing = std::max(missing, c.target - gap_of(mesh, c));
    if (missing < 0.05 * offset) return;
    waited = missing < 0.8 * least ? 0 : waited + 1;
    least = std::min(least, missing);
    move_vertices(mesh, constraints, limit, 0.01 * offset);
  }
}

}  // namespace

StartRepair repair_start(Scene& scene, double limit) {
  RepairMesh mesh(scene);
  const double offset = scene.parameters.impact_zones.offset;
  StartRepair result;
  std::vector<IntersectingFaces> pairs = intersections(mesh);
  result.pairs_before = result.pairs_left = pairs.size();

  // Contours that appear because of the moves are taken up in the next round. Such ones must not
  // lead deeper than what the moves were made for.
  double depth_limit = limit;
  std::vector<SidedContour> contours;
  std::vector<Vec3d> best = mesh.x;
  for (int round = 0; round < kMostRounds && !pairs.empty(); ++round) {
    if (!add_contours(mesh, pairs, depth_limit, contours)) break;
    if (round == 0) depth_limit = std::min(limit, 2 * deepest(contours));
    move_apart(mesh, contours, offset, limit, false);
    pairs = intersections(mesh);
    if (pairs.size() >= result.pairs_left) continue;
    result.pairs_left = pairs.size();
    best = mesh.x;
  }

  // The first step needs room also where a border lies beside the other sheet.
  if (result.pairs_left == 0 && result.pairs_before > 0) {
    move_apart(mesh, contours, offset, limit, true);
    if (!intersections(mesh).empty()) mesh.x = best;
    best = mesh.x;
  }

  // Vertices that were not moved keep their digits.
  std::size_t next = 0;
  for (Cloth& cloth : scene.cloths)
    for (Vec3d& p : cloth.mesh.positions) {
      const Vec3d from = mesh.start[next], to = best[next++];
      if (from == to) continue;
      ++result.moved;
      result.largest_move = std::max(result.largest_move, norm(to - from));
      p = to;
    }
  scene.repair = result;
  return result;
}

}  // namespace icloth
