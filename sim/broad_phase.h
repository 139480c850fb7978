// Broad phase shared by proximity and CCD: which VF and EE pairs can come together at all.
//
// Each vertex has a box that covers where it is and where it is expected to go, padded. The
// candidate pairs are those whose elements' boxes (hulls of their vertices' boxes) overlap. As long
// as all trajectories x0 → x1 stay in the boxes the list is complete, so it serves proximity, every
// CCD round, and the next steps too while the cloth hardly moves.
#pragma once

#include "kernels/bvh.h"
#include "sim/state.h"

namespace icloth::ICLOTH_BUILD {

/// Tree over a range of elements.
class Tree {
 public:
  /// Sorts the elements anew (Morton order of their boxes' centres), then refits.
  void build(View<const Box> boxes, Index first);
  /// New boxes, old order.
  void refit(View<const Box> boxes);
  bool empty() const { return items_.size() == 0; }
  TreeView view() const;

 private:
  Array<Index> items_;  ///< element numbers in leaf order
  Array<TreeNode> nodes_;
  Array<std::uint64_t> codes_;
  Index level_first_[kTreeLevels] = {};
  Index level_count_[kTreeLevels] = {};
  int levels_ = 0;
};

class BroadPhase {
 public:
  /// Makes the candidate lists cover x0 → x0 + dt·v and x0 ± thickness; does nothing while the
  /// present lists already do.
  void prepare(StepContext& step);
  /// Makes the candidate lists cover x0 → x1 as it is now.
  void cover_candidate(StepContext& step, bool after_impacts = false);
  /// Forgets the lists (the state was set from outside).
  void invalidate() { valid_ = false; }

  std::int64_t candidate_count() const {
    return std::int64_t{vertex_faces_.size()} + edge_edges_.size();
  }
  const Array<Pair>& vertex_faces() const { return vertex_faces_; }
  const Array<Pair>& edge_edges() const { return edge_edges_; }

 private:
  /// True while every path, with `margin` around it, lies in its vertex's trusted region.
  bool covers(StepContext& step, bool predicted, Real margin) const;
  void make_boxes(StepContext& step, bool predicted, bool after_impacts);
  void find_candidates(const StepContext& step);

  Array<Box> vertex_box_;  ///< trusted region of each vertex (vertices), make_boxes
  Array<Box> face_box_, edge_box_;
  Tree cloth_faces_, obstacle_faces_, cloth_edges_, obstacle_edges_;
  Array<Pair> vertex_faces_;  ///< (vertex, face) candidates, find_candidates
  Array<Pair> edge_edges_;    ///< (edge, edge) candidates, the smaller edge first
  Array<Pair> found_;         ///< one query's results
  int refits_ = 0;
  bool valid_ = false;
};

}  // namespace icloth::ICLOTH_BUILD
