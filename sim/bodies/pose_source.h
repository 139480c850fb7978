// Where the vertices of a body are over time, whatever it is that moves them.
#pragma once

#include <vector>

#include "kernels/vec.h"

namespace icloth {

class SkinnedPoses;

/// A pose depends on the time alone, so that a simulation that goes back in time finds the body
/// where it was.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// Whether the body is anywhere else at another time.
  virtual bool moves() const = 0;
  /// Vertex positions [m] at a time of the scene [s]; written to out (V).
  virtual void pose(double time, std::vector<Vec3d>& out) const = 0;
  /// Itself where bones move the body, so that the device of the solver may place the vertices;
  /// else null.
  virtual const SkinnedPoses* skinned() const { return nullptr; }
};

}  // namespace icloth
