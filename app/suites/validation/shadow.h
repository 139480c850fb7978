// The area that triangles cover when seen from above.
#pragma once

#include <vector>

#include "sim/files/mesh.h"

namespace icloth::validation {

/// A ground of squares, each of which counts as covered when its middle is.
class Shadow {
 public:
  /// The ground reaches from low to high in x and z [m], in squares of `cell`; anything outside is
  /// not seen.
  Shadow(Vec2d low, Vec2d high, double cell);

  void add(const std::vector<Vec3d>& positions, const std::vector<Triangle>& faces);
  void add_disc(Vec2d centre, double radius);

  double area() const;  ///< [m²]

 private:
  void add(Vec2d a, Vec2d b, Vec2d c);
  Vec2d middle(int i, int j) const {
    return {low_.x + cell_ * (i + 0.5), low_.y + cell_ * (j + 0.5)};
  }
  char& at(int i, int j) {
    return covered_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(i)];
  }

  Vec2d low_;
  double cell_;
  int columns_, rows_;
  std::vector<char> covered_;
};

}  // namespace icloth::validation
