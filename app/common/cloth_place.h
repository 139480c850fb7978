// What there is to know about a place on the cloth: for the pointer of the window and its
// clipboard.
#pragma once

#include <array>
#include <span>
#include <string>

#include "app/common/element_names.h"
#include "sim/scene/world.h"

namespace icloth {

struct ClothPlace {
  std::string face;                     ///< "cloth:NAME face 12"
  std::array<std::string, 3> vertices;  ///< "cloth:NAME vertex 7"
  Vec3d barycentric;                    ///< weights of the vertices
  Vec3d position;                       ///< [m]
  double strain = 0;                    ///< largest principal stretch of the face − 1

  /// "cloth:NAME face 12: strain 4.2 %".
  std::string text() const;
  /// An object with these values, for scripts and reports.
  std::string json() const;
};

/// The place on a face of a cloth, at the present positions of all vertices [m].
ClothPlace cloth_place(const World& world, const ElementNames& names,
                       std::span<const Vec3f> positions, Index face, Vec3d barycentric);

}  // namespace icloth
