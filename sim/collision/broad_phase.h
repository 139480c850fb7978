// The broad phase shared by proximity and CCD: it finds which VF and EE pairs can come together at
// all.
//
// Each vertex has two boxes, its trusted regions: around where its path starts and around where it
// is expected to end, padded. The candidate pairs are those of elements whose hulls may meet on
// straight ways from the first boxes to the second ones. The list is complete as long as all paths
// x0 → x1 lead from the first boxes to the second ones, or all of them stay in the second ones. So
// it serves proximity, every CCD round, and the next steps too while the cloth hardly moves. Where
// a few vertices end elsewhere, their boxes and their pairs alone are replaced.
//
// The boxes of the vertices are in the memory (State::trusted_start, trusted_end), and everything
// here follows from them except the shape of the trees, which decides how fast a search is and not
// what it finds, and the order of the lists.
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
    state.trusted_start.resize(0);
    state.trusted_end.resize(0);
    state.trusted_complete = false;
    current_ = false;
  }

  std::int64_t candidate_count() const {
    return std::int64_t{vertex_faces().size()} + edge_edges().size();
  }
  const Array<Pair>& vertex_faces() const { return candidates_.vertex_faces; }
  const Array<Pair>& edge_edges() const { return candidates_.edge_edges; }

 private:
  /// Counts the vertices whose paths, with `margin` around them, are not where the boxes have them.
  struct Leavers {
    Index fresh = 0;  ///< vertices that do not go from the first box to the second
    Index still = 0;  ///< vertices that do not stay in the second box
    bool none() const { return fresh == 0 || still == 0; }
  };
  static Leavers leavers(SubstepContext& step, bool predicted, Real margin);
  static bool covers(SubstepContext& step, bool predicted, Real margin) {
    return leavers(step, predicted, margin).none();
  }
  /// The slack of the boxes, which decides how long the lists last.
  static Real slack(const SubstepContext& step);
  /// Makes the boxes of all elements, and updates the trees.
  void make_boxes(SubstepContext& step, bool predicted, Real pad);
  /// Makes the boxes of faces and edges and the trees follow the boxes of the vertices.
  void update_hulls(SubstepContext& step);
  /// Fills the lists from the boxes. `dirty` is empty for all pairs.
  void find_candidates(SubstepContext& step, View<const std::uint8_t> dirty);
  /// Lists the pairs of the boxes, or those with a dirty vertex.
  void search(SubstepContext& step, View<const std::uint8_t> dirty, Candidates& out);
  /// Replaces the boxes and the pairs of the vertices that left theirs, where these are few cloth
  /// vertices. False where they are not.
  bool replace_leavers(SubstepContext& step, const Leavers& found);
  ElementBoxes boxes(const State& state) const {
    return {{state.trusted_start.view(), state.trusted_end.view()},
            {face_start_.view(), face_end_.view()},
            {edge_start_.view(), edge_end_.view()}};
  }

  Array<Box> face_start_, face_end_;  ///< hulls of the vertices' boxes (faces), update_hulls
  Array<Box> edge_start_, edge_end_;  ///< hulls of the vertices' boxes (edges), update_hulls
  TreePairs tree_;
  HashPairs hash_;
  Candidates candidates_;     ///< find_candidates, replace_leavers
  Candidates more_;           ///< of the vertices that left, replace_leavers
  Array<std::uint8_t> left_;  ///< 1: left its boxes (cloth_vertices), replace_leavers
  Array<Index> kept_;         ///< numbers of the pairs that are kept, replace_leavers
  Array<Pair> kept_pairs_;    ///< replace_leavers
  int refits_ = 0;            ///< of the trees since they were built
  bool current_ = false;      ///< hulls, trees and lists belong to the boxes of the memory
};

}  // namespace icloth::ICLOTH_BUILD
