// Parts of the small scenes that the stability cases are made of. SI units, Y up.
#pragma once

#include <memory>

#include "sim/scene/scene.h"
#include "sim/scene/shapes.h"

namespace icloth::stability {

/// Scene without air, with a thickness and offset that suit an edge length [m] of its cloth.
std::shared_ptr<Scene> new_scene(const char* name, double edge);

/// Square sheet of default fabric at rest with its middle at `centre`.
Cloth lying_sheet(double size, Index triangles, Vec3d centre);
Cloth hanging_sheet(double size, Index triangles, Vec3d centre);
/// Pins vertices of a sheet by a name of grid_vertices.
void pin(Cloth& cloth, const GridShape& shape, const char* name);

GridShape square(double size, Index triangles, bool lying);
Cloth make_cloth(const GridShape& shape, Vec3d centre);

/// Cone of cloth open at both ends, from `top` to `bottom` radius, hanging down from y = 0; rings
/// of nearly equilateral triangles, the first ring is pinned. Material coordinates jump at a seam.
Cloth make_tube(double top, double bottom, double length, Index triangles);

/// Cloth of given vertices and faces, at rest as it is.
Cloth cloth_of(std::vector<Vec3d> positions, std::vector<Triangle> faces);

/// Fabric with one stiffness in all directions, Young's modulus about `tensile` [N/m].
Material uniform_fabric(double tensile, double density, double bending);

Obstacle make_body(TriangleMesh mesh, Vec3d centre);
/// Pointed cone around y, its tip at y = 0.
TriangleMesh make_spike(double radius, double length, Index sides);

}  // namespace icloth::stability
