// The material space of a cloth: its texture coordinates taken as the flat pattern in metres.
#pragma once

#include <string>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// True where two faces lie side by side in material space along the edge that they share: the edge
/// has the same coordinates in both. Corner `i` starts the edge in the first face, corner `j` in
/// the second, each face running it in its own direction; `same_way` tells whether these agree.
bool joined_in_material(const std::array<Vec2d, 3>& first, std::size_t i,
                        const std::array<Vec2d, 3>& second, std::size_t j, bool same_way);

/// Panel of every face: faces that can be reached from each other without crossing a seam have the
/// same one. Panels are numbered in the order of their first faces. The mesh has uv.
std::vector<Index> find_panels(const TriangleMesh& mesh);

/// Twice the area of a face in material space, negative where it is mirrored [m²].
double doubled_material_area(const std::array<Vec2d, 3>& corners);

/// Mirrors panels that lie with their back up, u to −u, so that faces have positive areas. A panel
/// of which some faces are turned against the others follows the larger area.
void turn_mirrored_panels(TriangleMesh& mesh);

/// Why the coordinates cannot be a rest shape, naming the triangle; empty where they can. Mirrored
/// panels are to be turned before.
std::string rest_shape_problem(const TriangleMesh& mesh);

/// Area of the mesh in material space over its area at the given positions.
double material_share(const TriangleMesh& mesh, const std::vector<Vec3d>& positions);

/// Why the coordinates do not have the size of the rest positions, naming the triangle where it is
/// one; empty where they have it.
std::string size_problem(const TriangleMesh& mesh, const std::vector<Vec3d>& rest);

}  // namespace icloth
