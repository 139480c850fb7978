// From a pattern to a mesh that can be worn: panels are meshed, placed round the body, and sewn by
// making one vertex of the points that meet. Meshing takes long and depends on the flat pattern
// alone; placing and sewing are cheap and can be repeated with other placements.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "sim/files/mesh.h"
#include "sim/pattern/pattern.h"
#include "sim/pattern/pattern_checks.h"

namespace icloth {

/// Triangles that one pattern may be meshed into.
inline constexpr double kMostPatternTriangles = 4e6;

/// A meshed panel in its own plane.
struct PanelMesh {
  std::vector<Vec2d> points;    ///< [m] (V), the outline first, in the order of its edges
  std::vector<Triangle> faces;  ///< counter-clockwise in the plane (F)
  std::vector<std::vector<Index>> edge_points;  ///< points of each edge from start to end (E)
};

/// A pattern with its panels meshed. Both edges of a stitch have the same number of points.
struct MeshedPattern {
  Pattern pattern;
  double edge_length = 0;         ///< that was asked for [m]
  std::vector<PanelMesh> panels;  ///< as in pattern.panels
  std::vector<std::string> notes;
};

/// Meshes all panels with edges of about `edge_length` [m]. Throws InputError where that is too
/// short or a panel cannot be meshed.
MeshedPattern mesh_pattern(const Pattern& pattern, double edge_length);

/// Edge length [m] with which the whole pattern gets about so many triangles: √(2.31 area / N).
double edge_length_for(const Pattern& pattern, Index triangles);

/// Meshes all panels with `triangles` in all, within 1 % where an edge length for that is found.
/// Throws InputError as mesh_pattern does.
MeshedPattern mesh_with_count(const Pattern& pattern, Index triangles);

/// Number of triangles of all panels.
Index triangle_count(const MeshedPattern& meshed);

/// A seam of the garment: one stitch of the pattern. Vertices are those of the open mesh.
struct SewnSeam {
  Index panel_a = 0, edge_a = 0, panel_b = 0, edge_b = 0;
  double length_a = 0, length_b = 0;         ///< of the two edges in the flat pattern [m]
  std::vector<std::array<Index, 2>> points;  ///< pairs that are sewn together
  double mean_gap = 0, largest_gap = 0;      ///< between the points of a pair before sewing [m]
};

/// The longer edge of a seam over the shorter one; above kGatherRatio it gathers.
inline double gather_ratio(const SewnSeam& seam) {
  return std::max(seam.length_a, seam.length_b) / std::min(seam.length_a, seam.length_b);
}

/// Vertices of an edge with a label such as "lower_interface" or "collar", which can be held while
/// the garment is dressed.
struct LabelledEdge {
  std::string label;
  Index panel = 0, edge = 0;
  std::vector<Index> vertices;  ///< of the sewn mesh, along the edge
};

/// A garment round the body. The open mesh has the vertices of all panels one after the other; the
/// sewn mesh has one vertex for all points that are sewn together, at their mean. Right sides are
/// outside: there faces turn counter-clockwise. The uv are the flat panels, each beside the other,
/// so that no two of them have a point in common; a panel whose right side faces −z is mirrored.
struct SewnGarment {
  TriangleMesh mesh;                     ///< sewn
  std::vector<Index> panel;              ///< panel of each face (F)
  std::vector<std::string> panel_names;  ///< (panels)
  std::vector<Vec3d> open_positions;     ///< positions of the open mesh before sewing [m]
  std::vector<Index> merged;             ///< vertex of the open mesh → vertex of the sewn mesh
  std::vector<SewnSeam> seams;           ///< one a stitch, in their order
  std::vector<LabelledEdge> labelled;
  std::vector<std::string> notes;  ///< what the user should know: one line each, with the file
};

/// The placements that the pattern itself gives.
std::vector<PanelPlacement> placements_of(const Pattern& pattern);

/// Where the points of a panel stand [m].
std::vector<Vec3d> place_points(std::span<const Vec2d> points, const PanelPlacement& placement);

/// Places the panels and sews them. There is one placement for each panel.
SewnGarment sew_panels(const MeshedPattern& meshed, std::span<const PanelPlacement> placements);

/// Meshes, places and sews a pattern as it stands. The notes are those of all parts, reading
/// included. Throws InputError.
SewnGarment sew_pattern(const Pattern& pattern, double edge_length);

}  // namespace icloth
