// A scene flattened to the arrays that the stages and the renderer work on. Vertices, edges and
// faces of the cloths come first, in scene order, then those of the obstacles.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sim/files/mesh.h"
#include "sim/scene/rest_distances.h"
#include "sim/scene/scene.h"

namespace icloth {

struct WorldObject {
  std::string name;
  bool cloth = false;
  Index source = 0;  ///< index in scene.cloths or scene.obstacles
  Index first_vertex = 0, vertex_count = 0;
  Index first_face = 0, face_count = 0;
  std::optional<double> friction;  ///< its own Coulomb coefficient
};

/// Interior edge of a cloth with its two flaps; see bending.h for the roles of the vertices.
struct Hinge {
  std::array<Index, 4>
      vertices{};  ///< edge start, edge end, opposite in face 0, opposite in face 1
  Index face0 = 0, face1 = 0;
  double rest_angle = 0;   ///< [rad]
  double rest_length = 0;  ///< of the edge [m]
  double rest_area = 0;    ///< A₀ + A₁ [m²]
  double direction =
      0;              ///< of the edge against weft in face 0's material space, folded to [0, π/2]
  double weight = 1;  ///< 1/(n−1) on an edge with n faces
};

struct World {
  std::vector<WorldObject> objects;

  Index cloth_vertices = 0, vertices = 0;
  Index cloth_edges = 0, edges = 0;
  Index cloth_faces = 0, faces = 0;

  std::vector<Vec3d> position;  ///< start state [m] (vertices)
  std::vector<Vec3d>
      rest;  ///< rest shape in space, or laid out in the pattern [m] (cloth_vertices)
  std::vector<double> mass;          ///< lumped, before density_scale [kg] (cloth_vertices)
  std::vector<double> area;          ///< one third of the rest areas around [m²] (cloth_vertices)
  std::vector<std::uint8_t> pinned;  ///< (cloth_vertices)
  std::vector<Index> object;         ///< index into objects (vertices)

  std::vector<Triangle> face;              ///< (faces)
  std::vector<std::array<Index, 2>> edge;  ///< smaller vertex first, sorted in each object (edges)
  std::vector<double> face_area;           ///< rest area [m²] (cloth_faces)
  std::vector<double> edge_area;  ///< one third of the rest areas beside [m²] (cloth_edges)
  /// Rows r₀, r₁ of Dm⁻¹ [1/m] (cloth_faces): material-space inverse edge matrix.
  std::vector<std::array<double, 4>> face_inverse;
  std::vector<Index> face_material;  ///< index into scene.cloths (cloth_faces)
  std::vector<Hinge> hinges;

  /// Of all cloths, with vertices of the world; empty where no cloth has its rest shape in uv.
  RestDistances rest_distances;

  double median_edge = 0;  ///< of the cloths, at rest [m]
};

/// Appends the lengths at rest of the sides of all faces; an edge of two faces counts twice.
void add_rest_lengths(const Cloth& cloth, std::vector<double>& lengths);

/// Throws InputError naming object and element: zero-area rest face, vertex without mass or with a
/// coordinate that is not finite.
World make_world(const Scene& scene);

}  // namespace icloth
