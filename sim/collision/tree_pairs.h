// Candidate pairs by bounding volume trees: vertices against faces, edges against edges.
#pragma once

#include "sim/collision/candidates.h"
#include "sim/collision/tree.h"

namespace icloth::ICLOTH_BUILD {

class TreePairs {
 public:
  /// Takes new boxes. With `rebuild` the order of the leaves is made anew as well.
  void update(const Topology& mesh, const ElementBoxes& boxes, bool rebuild);

  /// Finds all pairs whose boxes overlap and that do not stay apart.
  void find(const Topology& mesh, const ElementBoxes& boxes, Candidates& out);
  /// Finds those of them that have a dirty vertex. `dirty` holds 1 or 0
  /// (cloth_vertices).
  void find_dirty(const Topology& mesh, const ElementBoxes& boxes, View<const std::uint8_t> dirty,
                  Candidates& out);

  /// Counts the boxes that the queries compare with, which takes about as long as they do.
  bool count_tests = false;

 private:
  template <class Query>
  void run(const char* name, Index elements, const Query& query, Array<Pair>& list,
           Candidates& out);

  Tree cloth_faces_, obstacle_faces_, cloth_edges_, obstacle_edges_;
  CurveOrder cloth_vertices_, obstacle_vertices_;
  Tree dirty_face_tree_;
  Array<Index> dirty_vertices_, dirty_faces_, dirty_edges_;
  Array<Pair> found_;  ///< one query's results
};

}  // namespace icloth::ICLOTH_BUILD
