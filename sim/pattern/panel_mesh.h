// Triangles for the inside of an outline.
#pragma once

#include <span>
#include <vector>

#include "sim/files/grid_point.h"
#include "sim/files/mesh.h"

namespace icloth {

/// What mesh_outline makes. Either the mesh is whole, or edges of the ring are missing.
struct OutlineMesh {
  std::vector<GridPoint> points;  ///< the ring, then the points inside
  std::vector<Triangle> faces;    ///< counter-clockwise; they cover the inside once
  std::vector<Index> missing;     ///< ring edges i → i + 1 that no triangle has; then no faces
};

/// Fills a ring of points, which turns counter-clockwise and does not cross itself, with triangles
/// whose edges have about the given length [grid]. The points inside are those of a hexagonal
/// lattice, moved in ten rounds towards an optimal Delaunay triangulation (Chen and Holst 2011).
/// The mesh is the Delaunay triangulation of all points, without what lies outside.
///
/// Where that lacks an edge of the ring, because another point is too near to the edge, the edge is
/// reported, and the caller divides it. A ring that cannot be meshed at all, since it touches
/// itself, gives neither faces nor missing edges.
OutlineMesh mesh_outline(std::span<const GridPoint> ring, double edge_length);

/// All triangles of the Delaunay triangulation of points, counter-clockwise. Where more than three
/// points lie on one empty circle, which of them are joined depends on their order alone.
std::vector<Triangle> delaunay_triangles(std::span<const GridPoint> points);

}  // namespace icloth
