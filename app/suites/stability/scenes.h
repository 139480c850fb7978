// Parts of the small scenes that the stability cases are made of, in SI units with Y up.
#pragma once

#include <memory>

#include "sim/scene/scene.h"
#include "sim/scene/shapes.h"

namespace icloth::stability {

/// A scene without air, with a thickness and an offset that suit an edge length [m] of its cloth.
std::shared_ptr<Scene> new_scene(const char* name, double edge);

/// Square sheets of default fabric, at rest with their middle at `centre`.
Cloth lying_sheet(double size, Index triangles, Vec3d centre);
Cloth hanging_sheet(double size, Index triangles, Vec3d centre);
/// Pins vertices of a sheet by a name of grid_vertices.
void pin(Cloth& cloth, const GridShape& shape, const char* name);

GridShape square(double size, Index triangles, bool lying);
Cloth make_cloth(const GridShape& shape, Vec3d centre);

/// A cone of cloth open at both ends, from `top` to `bottom` radius, which hangs down from y = 0.
/// It has rings of nearly equilateral triangles, the first of which is pinned. Material coordinates
/// jump at a seam.
Cloth make_tube(double top, double bottom, double length, Index triangles);

/// A cloth of given vertices and faces, at rest as it is.
Cloth cloth_of(std::vector<Vec3d> positions, std::vector<Triangle> faces);

/// A fabric with one stiffness in all directions, with a Young's modulus of about `tensile` [N/m].
Material uniform_fabric(double tensile, double density, double bending);

Obstacle make_body(TriangleMesh mesh, Vec3d centre);
/// A pointed cone around y, with its tip at y = 0.
TriangleMesh make_spike(double radius, double length, Index sides);

}  // namespace icloth::stability
