// The broad phase shared by proximity and CCD: it finds which VF and EE pairs can come together at
// all.
//
// Each vertex has a box, its trusted region, that covers its position and its expected path,
// padded. The candidate pairs are those whose elements' boxes (hulls of their vertices' boxes)
// overlap. As long as all trajectories x0 → x1 stay in the boxes the list is complete, so it serves
// proximity, every CCD round, and the next steps too while the cloth hardly moves. The boxes of the
// vertices are in the memory (State::trusted), and everything here follows from them except the
// shape of the trees, which decides how fast a search is and not what it finds.
#pragma once

#include "sim/collision/hash_pairs.h"
#include "sim/collision/tree_pairs.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

class BroadPhase {
 public:
  /// Makes the candidate lists cover x0 → x0 + dt·v and x0 ± thickness; does nothing while the
  /// present lists already do.
  void prepare(SubstepContext& step);
  /// Makes the candidate lists cover x0 → x1 as it is now.
  void cover_candidate(SubstepContext& step);
  /// Makes the lists cover x0 → x1 for pairs with a dirty vertex (cloth_vertices) alone, where they
  /// do not cover it already: the clean pairs have been tested.
  void cover_dirty(SubstepContext& step, View<const std::uint8_t> dirty);
  /// Makes boxes and lists anew even where they are valid, as a detection without coherence would.
  void cover_again(SubstepContext& step);
  /// Must be called after the memory was replaced: what follows from its boxes is made anew.
  void follow_memory() { current_ = false; }
  /// Drops the boxes, so that the next step makes others.
  void invalidate(State& state) {
    state.trusted.resize(0);
    state.trusted_complete = false;
    current_ = false;
  }

  std::int64_t candidate_count() const {
    return std::int64_t{vertex_faces().size()} + edge_edges().size();
  }
  const Array<Pair>& vertex_faces() const { return candidates_.vertex_faces; }
  const Array<Pair>& edge_edges() const { return candidates_.edge_edges; }

 private:
  /// True while every path, with `margin` around it, lies in its vertex's trusted region.
  static bool covers(SubstepContext& step, bool predicted, Real margin);
  /// The slack of the boxes, which decides how long the lists last.
  static Real slack(const SubstepContext& step);
  /// Makes the boxes of all elements, and updates the trees.
  void make_boxes(SubstepContext& step, bool predicted, Real pad);
  /// Makes the boxes of faces and edges and the trees follow the boxes of the vertices.
  void update_hulls(SubstepContext& step);
  /// Fills the lists from the boxes. `dirty` is empty for all pairs.
  void find_candidates(SubstepContext& step, View<const std::uint8_t> dirty);
  ElementBoxes boxes(const State& state) const {
    return {state.trusted.view(), face_box_.view(), edge_box_.view()};
  }

  Array<Box> face_box_, edge_box_;  ///< hulls of the vertices' boxes (faces), (edges), update_hulls
  TreePairs tree_;
  HashPairs hash_;
  Candidates candidates_;  ///< find_candidates
  int refits_ = 0;         ///< of the trees since they were built
  bool current_ = false;   ///< hulls, trees and lists belong to the boxes of the memory
};

}  // namespace icloth::ICLOTH_BUILD
