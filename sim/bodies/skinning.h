// Skinned bodies where the solver runs.
#pragma once

#include "kernels/parallel/array.h"
#include "kernels/skinning.h"
#include "kernels/stencil.h"
#include "sim/bodies/skinned_poses.h"

namespace icloth::ICLOTH_BUILD {

/// One body in the memory of the device. The host poses its bones, of which there are few; the
/// device places the vertices.
class Skinning {
 public:
  /// `first_vertex`: of the body among all vertices.
  Skinning(const Rig& rig, Index first_vertex);

  /// Writes where the body is to its vertices among all.
  void place(const SkinPose& pose, View<Vec3r> x);

 private:
  Index first_vertex_;
  Array<Vec3d> rest_;          ///< (V)
  Array<Index> weight_first_;  ///< (V + 1)
  Array<Index> weight_bone_;   ///< (weights)
  Array<double> weight_;       ///< (weights)
  Array<Index> morph_first_;   ///< (V + 1), empty without morph targets
  Array<Index> morph_target_;  ///< (displacements)
  Array<Vec3d> morph_delta_;   ///< [m] of the file (displacements)
  Array<Affine> bone_;         ///< (bones), place
  Array<double> morph_;        ///< (targets), place
};

}  // namespace icloth::ICLOTH_BUILD
