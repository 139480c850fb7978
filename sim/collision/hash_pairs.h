// Candidate pairs by spatial hashing, the broad phase of the paper's family (Section 3; Tang et al.
// 2018, "PSCC"): a uniform grid, sorted cells, and the tests of all cells dealt out evenly.
//
// Deviations: cells hold vertices, edges and faces instead of triangles, so that no triangle has to
// be made responsible for a pair of features. Keys are the cell's three coordinates (21 bits each),
// so that no two cells ever share one. Elements over more than 64 cells are kept apart and tested
// against all others. A pair is reported by the cell that holds the lower corner of the overlap of
// its two boxes (the token; Fan et al. 2011), hence once.
#pragma once

#include "sim/collision/candidates.h"

namespace icloth::ICLOTH_BUILD {

class HashPairs {
 public:
  /// Finds all pairs whose boxes overlap and that do not stay apart.
  void find(const Topology& mesh, const ElementBoxes& boxes, Candidates& out);
  /// Finds those of them that have a dirty vertex, by finding all pairs and dropping the others.
  void find_dirty(const Topology& mesh, const ElementBoxes& boxes, View<const std::uint8_t> dirty,
                  Candidates& out);

 private:
  template <class Pairs>
  void run(const char* name, const Pairs& pairs, Array<Pair>& list, Candidates& out);

  Array<std::uint64_t> key_;  ///< cell of each entry, sorted
  Array<Index> element_;      ///< of each entry
  Array<Index> entry_first_;  ///< first entry of each element, and the end
  Array<Index> cell_first_;   ///< first entry of each cell, and the end
  Array<Index> item_first_;   ///< first work item of each cell, and the end
  Array<Index> large_;        ///< elements that are in no cell
  Array<Index> kept_;         ///< numbers of the pairs with a dirty vertex, find_dirty
  Array<Pair> found_;
};

}  // namespace icloth::ICLOTH_BUILD
