// Procedural meshes: sheets of cloth and simple bodies.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// A rectangle of cloth, in rows of nearly equilateral triangles (every second row is shifted by
/// half an edge, the borders are straight): such meshes bend alike in all directions.
struct GridShape {
  double width = 1, height = 1;  ///< along u (weft) and v (warp) [m], > 0
  Index triangles = 2000;        ///< wanted, ≥ 2; met to within a row
  bool horizontal = false;       ///< lies in xz with +y its front; false: stands in xy, front +z
  double bend_radius = 0;        ///< > 0: the middle of the width lies on an arc [m], ends straight
  double bend_angle = 180;       ///< of the arc [degrees]
};

struct GridMesh {
  TriangleMesh mesh;        ///< centred on the origin, bent; uv = (u, v) from the lower left corner
  std::vector<Vec3d> rest;  ///< the flat rectangle [m] (V)
  std::vector<Index> row;   ///< first vertex of each row, from the bottom, then the end (rows + 1)
};

/// Vertices are numbered row by row from the bottom left (seen from the front). A bend stands
/// upright for a vertical grid (a U open towards +z) and is an arch for a horizontal one.
GridMesh make_grid(const GridShape& shape);

/// Names of vertices: corners "top_left" …, middles of the borders "left_end" "right_end"
/// "top_middle" "bottom_middle", "center", and whole borders "top" "bottom" "left" "right".
/// Empty for an unknown name.
std::vector<Index> grid_vertices(const GridMesh& grid, std::string_view name);
/// All names that grid_vertices knows.
std::vector<std::string_view> grid_vertex_names();

/// Subdivided icosahedron, 20·n² triangles with the smallest n that gives at least `triangles`.
TriangleMesh make_sphere(double radius, Index triangles);
/// Cylinder along y with half-spheres at its ends; `length` is that of the cylinder's axis.
TriangleMesh make_capsule(double radius, double length, Index triangles);
/// Axis-parallel box around the origin with faces cut into squares of about `edge`.
TriangleMesh make_box(Vec3d size, double edge);
/// Rectangle in xz around the origin, facing +y.
TriangleMesh make_plane(double width, double depth, double edge);

/// Hollow funnel around y with walls of a thickness: a cone from `top_radius` at y = 0 down to
/// `bottom_radius` at −cone_height, then a pipe of pipe_length. Radii are those of the inner wall.
struct FunnelShape {
  double top_radius = 0.5, bottom_radius = 0.1, cone_height = 0.4, pipe_length = 0.2;
  double wall = 0.01;  ///< [m]
  double edge = 0.02;  ///< wanted edge length [m]
};
TriangleMesh make_funnel(const FunnelShape& shape);

/// Every triangle cut into four at the middles of its edges; old vertices keep their numbers.
/// `rest` (V or 0) is refined alike.
void subdivide(TriangleMesh& mesh, std::vector<Vec3d>& rest);

}  // namespace icloth
