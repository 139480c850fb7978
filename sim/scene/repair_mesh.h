// The start state of a scene as one surface with its neighbourhoods, for the repair.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/files/mesh.h"
#include "sim/scene/scene.h"

namespace icloth {

/// Lists of different lengths in one array: list i is items[first[i]] … items[first[i + 1] − 1].
struct IndexLists {
  std::vector<Index> first, items;

  std::span<const Index> operator[](Index i) const {
    const auto begin = static_cast<std::size_t>(first[static_cast<std::size_t>(i)]);
    const auto end = static_cast<std::size_t>(first[static_cast<std::size_t>(i) + 1]);
    return std::span(items).subspan(begin, end - begin);
  }
};

/// Cloths and obstacles as one list of vertices, edges and faces. Faces are turned so that
/// neighbours agree on which side is up, and closed bodies face outwards.
struct RepairMesh {
  std::vector<Vec3d> x;            ///< positions [m] (V), rounded to single precision
  std::vector<Vec3d> start;        ///< x before the repair [m] (V)
  std::vector<Vec3d> base;         ///< x from which the present moves count [m] (V)
  std::vector<std::uint8_t> free;  ///< 1 for vertices that may be moved (V)
  std::vector<Index> part;         ///< number of the connected part that a vertex belongs to (V)
  std::vector<Triangle> faces;     ///< (F)
  std::vector<int> group;          ///< 0: cloth, −1: obstacle (F)
  std::vector<std::array<Index, 2>> edges;       ///< (E)
  std::vector<std::array<Index, 3>> face_edges;  ///< edge k joins the corners k and k + 1 (F)
  IndexLists edge_faces, vertex_faces;           ///< faces of an edge, of a vertex

  explicit RepairMesh(const Scene& scene);

  const Vec3d& position(Index v) const { return x[static_cast<std::size_t>(v)]; }
  std::array<Vec3d, 3> corners(Index f) const;
  Vec3d normal(Index f) const;          ///< unit; 0 for a face without area
  Vec3d edge_normal(Index edge) const;  ///< sum of the unit normals of its faces
  bool is_body(Index f) const { return group[static_cast<std::size_t>(f)] < 0; }
  bool is_free(Index v) const { return free[static_cast<std::size_t>(v)] != 0; }

 private:
  void add(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, int number);
  void make_edges();
  void turn_faces();
};

/// The point of a surface that is closest to a given one.
struct SurfacePoint {
  Index face = -1;
  std::array<double, 3> w{};  ///< barycentric weights in the face
  double height = 0;          ///< signed distance: positive on the side of the face normals [m]
  Vec3d normal;               ///< unit, the direction in which the height grows
  bool beyond = false;        ///< the closest point lies on the border of the surface
};

/// Walks over neighbouring faces from the face `from` to the point closest to p. The walk finds the
/// nearest point of this layer of cloth and not of another layer that happens to be closer.
SurfacePoint walk_to_closest(const RepairMesh& mesh, Vec3d p, Index from);

}  // namespace icloth
