// Vertices of a mesh file that share a place become one, and those that no face uses are left out.
#pragma once

#include <span>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// How the vertices of a mesh file stand for those that are simulated. Vertices at the same place
/// can be one vertex of the mesh, and those that no face uses are left out of it; exported files
/// still have all of them, in the order of the file.
struct FileLayout {
  std::vector<Index> vertex;     ///< number in the mesh, kNone: no face uses it (file vertices)
  std::vector<Vec3d> positions;  ///< at the start [m] (file vertices)
  std::vector<Triangle> faces;   ///< indices of file vertices (F)

  /// True where the mesh has exactly the vertices of its file.
  bool is_identity() const { return vertex.empty(); }
};

/// Counts of the vertices of a file that are not simulated by themselves.
struct WeldReport {
  std::size_t welded = 0;  ///< vertices that are at the place of an earlier one, and now the same
  std::size_t apart = 0;   ///< the same, but their rest places differ: they stay two
  std::size_t unused = 0;  ///< vertices without a face
};

/// Moves every vertex that a face uses onto the nearest of the earlier ones within `distance`
/// [m], in the mesh and in the rest shape, that were not moved themselves. So none moves farther
/// than `distance`, and chains of near vertices do not shrink to a point. `scale` is the size that
/// the mesh is going to have. Time and memory grow with the number of vertices: false where more
/// than a bounded number lies within reach of one.
bool snap_vertices(TriangleMesh& mesh, std::vector<Vec3d>& rest, double distance, Vec3d scale);

/// Leaves out the vertices without a face and, with `weld`, makes one of those whose start and
/// rest places are exactly equal; the first one of the file keeps its place in the order. `layout`
/// is filled where the mesh changes.
WeldReport merge_vertices(TriangleMesh& mesh, std::vector<Vec3d>& rest, bool weld,
                          FileLayout& layout);

/// Counts the vertices on the border of a mesh that lie within `distance` of another one on the
/// border without sharing an edge with it, as at a seam that is not closed.
std::size_t near_border_vertices(const TriangleMesh& mesh, double distance);

/// Number in the file of every vertex of the mesh, the first one of those that share its place.
std::vector<Index> file_numbers(const FileLayout& layout);

}  // namespace icloth
