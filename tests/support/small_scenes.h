// Small scenes made in code: sheets of cloth and bodies.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/material_io.h"
#include "sim/scene/scene.h"
#include "sim/scene/shapes.h"

namespace icloth::testing {

/// Rectangle of default fabric at rest with its middle at `centre`; `shape` gives size and posture.
inline Cloth make_sheet(const GridShape& shape, Vec3d centre) {
  GridMesh grid = make_grid(shape);
  Cloth cloth;
  cloth.name = "sheet";
  cloth.mesh = std::move(grid.mesh);
  for (Vec3d& p : cloth.mesh.positions) p += centre;
  cloth.rest = std::move(grid.rest);
  cloth.material = load_material("default", "");
  return cloth;
}

inline GridShape lying(double size, Index triangles) {
  GridShape shape;
  shape.width = shape.height = size;
  shape.triangles = triangles;
  shape.horizontal = true;
  return shape;
}

inline GridShape hanging(double size, Index triangles) {
  GridShape shape = lying(size, triangles);
  shape.horizontal = false;
  return shape;
}

inline Obstacle make_obstacle(TriangleMesh mesh, Vec3d centre) {
  Obstacle obstacle;
  obstacle.name = "body";
  for (Vec3d& p : mesh.positions) p += centre;
  obstacle.mesh = std::move(mesh);
  return obstacle;
}

}  // namespace icloth::testing
