// A sewing pattern as it is read: flat panels with curved edges, and the stitches between them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/vec.h"

namespace icloth {

/// Limits of a pattern file, checked before memory is taken.
inline constexpr std::size_t kMostPanels = 1000;
inline constexpr std::size_t kMostPanelEdges = 10'000;      ///< of all panels together
inline constexpr std::size_t kMostOutlinePoints = 200'000;  ///< of all polylines together

enum class EdgeCurve { straight, quadratic, cubic, circle, polyline };

/// One edge of a panel, from one corner to the next one of the loop.
struct PanelEdge {
  Index start = 0, end = 0;  ///< corners
  EdgeCurve curve = EdgeCurve::straight;
  std::array<Vec2d, 2> control;    ///< control points in the plane of the panel [m]; quadratic: one
  double radius = 0;               ///< of a circle, at least half the chord [m]
  std::vector<Vec2d> points;       ///< of a polyline, between the corners [m]
  bool large_arc = false;          ///< the larger one of the two arcs
  bool counter_clockwise = false;  ///< turn of the arc, which then bulges to the right of the edge
  std::string label;               ///< "collar", "lower_interface" …; empty: none
};

/// How a panel stands in space at the start. A point (x, y) of the panel goes to R (x, y, 0) + t,
/// or to R (r sin(x/r), y, r (cos(x/r) − 1)) + t where it is bent. R = Rz Ry Rx.
struct PanelPlacement {
  Vec3d translation;       ///< t [m]; y up, the wearer faces +z, feet at y = 0
  Vec3d rotation;          ///< about x, y and z [degrees]
  double bend_radius = 0;  ///< r [m]; 0: flat; below 0: bent the other way, hollow towards +z
};

struct Panel {
  std::string name;
  std::string label;             ///< part of the body; empty: none
  std::vector<Vec2d> corners;    ///< y up [m]
  std::vector<PanelEdge> edges;  ///< a closed loop
  bool clockwise = false;        ///< turn of the loop; the right side then faces −z
  PanelPlacement placement;
};

/// A whole edge of a panel.
struct PanelSide {
  Index panel = 0, edge = 0;
};

/// Two edges that are sewn together, point by point from one end to the other. The start of one
/// edge meets the end of the other, unless the right side of one panel comes to lie on the wrong
/// side of the other: then the starts meet.
struct Stitch {
  std::array<PanelSide, 2> sides;
  bool right_wrong = false;
};

struct Pattern {
  std::string file;  ///< as messages name it
  std::vector<Panel> panels;
  std::vector<Stitch> stitches;    ///< an edge belongs to at most one
  std::vector<std::string> notes;  ///< what the user should know: one line each, with the file
};

/// Reads a pattern: a DXF file by its extension (.dxf), all others in the JSON of GarmentCode;
/// docs/patterns.md says what is read. Throws InputError with file, panel, edge, value and what was
/// expected.
Pattern read_pattern(const std::string& path);

/// The JSON from memory. `name`: of the file, for messages.
Pattern parse_pattern(std::string_view text, const std::string& name);

/// The panels of a DXF file (AAMA/ASTM) from memory. It has no stitches and no placement.
Pattern parse_pattern_dxf(std::string_view text, const std::string& name);

}  // namespace icloth
