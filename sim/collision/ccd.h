// Stage 3: all VF and EE pairs whose linear trajectories x0 → x1 meet (paper Section 3).
//
// The first round tests every candidate. Later rounds test only pairs with a dirty vertex, which is
// one whose end position has changed since the last round, or one of a colliding pair. (This
// corrects the paper's T_d: with the vertices of colliding pairs alone, moved neighbours would be
// missed.)
#pragma once

#include "kernels/impact.h"
#include "sim/collision/broad_phase.h"
#include "sim/collision/let_go.h"
#include "sim/linear/incidence.h"
#include "sim/state/state.h"

namespace icloth::ICLOTH_BUILD {

class Ccd {
 public:
  /// Finds the impacts, sorted by key. `dirty` (cloth_vertices) is only read when `incremental`;
  /// pairs that `let_go` ignores are left out.
  void find(SubstepContext& step, const BroadPhase& broad_phase, View<const std::uint8_t> dirty,
            bool incremental, const LetGoView& let_go = {});

  const Array<Impact>& impacts() const { return impacts_; }

 private:
  Array<Impact> impacts_, found_;
  SortedAppend append_sorted_;
};

}  // namespace icloth::ICLOTH_BUILD
