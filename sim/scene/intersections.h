// Exact intersection test of triangle soups: start states, `icloth check`, tests.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh.h"
#include "sim/scene/box_tree.h"
#include "sim/scene/exact_triangles.h"
#include "sim/scene/scene.h"
#include "sim/scene/touching.h"

namespace icloth {

struct IntersectingFaces {
  Index a, b;  ///< face numbers in the soup, a < b
};

/// Every pair of faces that touches or crosses and shares no vertex, sorted. Exact for the given
/// doubles. Faces with group[f] < 0 are not tested among themselves (obstacles).
/// `group` may be empty (all faces are tested against all).
std::vector<IntersectingFaces> find_intersections(std::span<const Vec3d> positions,
                                                  std::span<const Triangle> faces,
                                                  std::span<const int> group);

/// Faces with their boxes in a tree, for tests that are repeated while other faces move.
class FaceTree {
 public:
  FaceTree(std::span<const Vec3d> positions, std::span<const Triangle> faces);
  FaceTree(const FaceTree&) = delete;  // the tree refers to the boxes
  FaceTree& operator=(const FaceTree&) = delete;

  std::size_t size() const { return corners_.size(); }
  const FaceCorners& corners(Index face) const { return corners_[static_cast<std::size_t>(face)]; }
  const Box& box(Index face) const { return boxes_[static_cast<std::size_t>(face)]; }

  /// Calls visit(i) for every face i whose box overlaps `query`.
  template <class Visit>
  void visit(const Box& query, const Visit& visit_face) const {
    tree_.visit(query, visit_face);
  }

 private:
  std::vector<FaceCorners> corners_;
  std::vector<Box> boxes_;
  BoxTree tree_;
};

/// Every pair of faces that touches or crosses and shares no vertex, sorted, where the first is one
/// of `faces`. The faces of `fixed` have the numbers after those and are not tested among
/// themselves. It gives what the function above gives for the two soups in one, in less time where
/// `fixed` is tested again and again.
std::vector<IntersectingFaces> find_intersections(std::span<const Vec3d> positions,
                                                  std::span<const Triangle> faces,
                                                  const FaceTree& fixed);

/// Faces that touch or cross in the start state of a scene, which cannot be simulated then. Numbers
/// count cloths in scene order, then obstacles.
struct StartConflicts {
  std::vector<IntersectingFaces> pairs;  ///< faces without a common vertex that touch or cross
  std::vector<Touch> touches;            ///< of neighbouring faces, with a vertex that can move
};
/// `single_precision`: positions are rounded first, as the builds in single precision see them.
StartConflicts find_start_conflicts(const Scene& scene, bool single_precision);

/// All pairs of faces of the conflicts, neighbours included, sorted.
std::vector<IntersectingFaces> face_pairs(const StartConflicts& conflicts);
/// The same for the conflicts that are found in a scene.
std::vector<IntersectingFaces> find_start_intersections(const Scene& scene, bool single_precision);

}  // namespace icloth
