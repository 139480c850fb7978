// Parts of the small scenes that the validation cases are made of, in SI units with Y up.
#pragma once

#include <functional>
#include <memory>

#include "sim/scene/scene.h"

namespace icloth::validation {

/// A scene without air and contacts, solved to ten digits, in which no step is halved.
std::shared_ptr<Scene> exact_scene(const char* name);

/// A fabric with constant coefficients: plane stress with Young's modulus `tensile` [N/m] and
/// Poisson's ratio; `modulus` is D, the bending moment per width and curvature [N·m].
Material plain_fabric(double tensile, double poisson, double density, double modulus);

/// A strip of equilateral triangles in rows across its length, with straight borders: odd rows are
/// shifted by half an edge and have one vertex more. Cloth bends along the rows without any strain.
struct Strip {
  double length = 1;  ///< along v [m]
  Index rows = 40;    ///< of triangles, along the length
  Index columns = 4;  ///< of whole triangles, across

  double row_height() const { return length / rows; }
  double edge() const;   ///< [m]
  double width() const;  ///< [m]
  /// The vertices of row r = 0 … rows.
  std::vector<Index> row(Index r) const;
  Index vertices() const;
};

/// The strip with its vertices at place(u, v), u across from −width/2 and v along from 0; its rest
/// shape is flat. Rows are pinned by `pin_row`.
Cloth strip_cloth(const Strip& strip, const std::function<Vec3d(double, double)>& place,
                  const Material& material);
void pin_row(Cloth& cloth, const Strip& strip, Index row);

/// The mean position of a row.
Vec3d row_mean(const Strip& strip, const std::vector<Vec3d>& positions, Index row);

/// The lumped masses of a cloth [kg] (V).
std::vector<double> lumped_mass(const Cloth& cloth);

}  // namespace icloth::validation
