#include "sim/scene/cloth_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/index.h"
#include "sim/files/box.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/scene/edge_lengths.h"
#include "sim/scene/shapes.h"

namespace icloth {
namespace {

/// A text such as "3 of 120 vertices".
std::string count_of(std::size_t some, std::size_t all) {
  return std::to_string(some) + " of " + std::to_string(all) + " vertices";
}

/// A distance that a gap of a seam may have and an edge may not: far below the median edge, and
/// below the shortest one, so that welding by it loses no face.
double seam_gap(const TriangleMesh& mesh) {
  std::vector<double> lengths;
  add_side_lengths(mesh.faces, mesh.positions, lengths);
  return std::min(1e-3 * median(lengths), 0.5 * std::ranges::min(lengths));
}

/// Moves near vertices together; a face must not lose a corner by that.
void snap(Cloth& cloth, const ClothMeshOptions& options) {
  const std::string where =
      options.file + ": weld: value " + rounded_text(options.weld.distance, 6);
  if (!snap_vertices(cloth.mesh, cloth.rest, options.weld.distance, options.scale))
    throw InputError(where + " m reaches hundreds of vertices at once, expected less than an edge");

  // A triangle with two corners at one place would have no area at rest.
  for (std::size_t f = 0; f < cloth.mesh.faces.size(); ++f) {
    const Triangle& t = cloth.mesh.faces[f];
    for (std::size_t c = 0; c < 3; ++c)
      if (cloth.mesh.positions[at(t[c])] == cloth.mesh.positions[at(t[(c + 1) % 3])])
        throw InputError(where + " m joins vertices " + std::to_string(t[c]) + " and " +
                         std::to_string(t[(c + 1) % 3]) + " of triangle " + std::to_string(f) +
                         ", expected less than its edges");
  }
}

/// Vertices of the file, the first `count` of the layout, that are simulated as an earlier one.
std::size_t count_welded(const FileLayout& layout, std::size_t count) {
  const std::vector<Index> first = file_numbers(layout);
  const auto used = std::count_if(layout.vertex.begin(),
                                  layout.vertex.begin() + static_cast<std::ptrdiff_t>(count),
                                  [](Index v) { return v != kNone; });
  const auto kept = std::ranges::count_if(first, [&](Index v) { return at(v) < count; });
  return static_cast<std::size_t>(used - kept);
}

/// A length with three digits, and all of those before the point: 0.412, 1800.
std::string metres_text(double length) {
  return length >= 100 && length < 1e7 ? std::to_string(std::llround(length))
                                       : rounded_text(length);
}

/// Faces with the same vertices as an earlier one.
std::size_t count_repeated_faces(const TriangleMesh& mesh) {
  std::vector<Triangle> faces = mesh.faces;
  for (Triangle& t : faces) std::ranges::sort(t);
  std::ranges::sort(faces);
  return static_cast<std::size_t>(faces.end() - std::unique(faces.begin(), faces.end()));
}

/// Notes how many vertices are unused, welded or nearly at one place; `count` come from the file.
void note_vertices(const TriangleMesh& mesh, const FileLayout& layout,
                   const ClothMeshOptions& options, std::size_t count, const WeldReport& report,
                   std::vector<std::string>& notes) {
  if (report.unused > 0)
    notes.push_back(options.object + ": " + count_of(report.unused, count) +
                    " belong to no face and stay where they are");
  if (report.welded > 0) {
    const std::size_t welded = count_welded(layout, count);
    notes.push_back(options.object + ": " + count_of(welded, count) +
                    " lie at the same place as earlier ones and are welded to them" +
                    (options.weld.asked ? ""
                                        : " (\"weld\": false keeps them apart, a distance in "
                                          "metres welds near ones too)"));
  }
  if (report.apart > 0)
    notes.push_back(options.object + ": " + count_of(report.apart, count) +
                    " lie at the same place as earlier ones, but not in the rest shape, and are "
                    "not welded");

  if (const std::size_t repeated = count_repeated_faces(mesh); repeated > 0)
    notes.push_back(options.object + ": " + std::to_string(repeated) + " of " +
                    std::to_string(mesh.faces.size()) +
                    " faces have the same vertices as earlier ones: the cloth is there twice, with "
                    "twice the mass and the stiffness");

  // Seams that rounding opened by a little cannot run, and look closed in every picture.
  if (options.weld.asked || report.apart > 0) return;
  const double largest = std::max({options.scale.x, options.scale.y, options.scale.z});
  const std::string distance = rounded_text(largest * seam_gap(mesh), 1);
  const std::size_t near = near_border_vertices(mesh, std::stod(distance) / largest);
  if (near > 0)
    notes.push_back(options.object + ": " + count_of(near, count) + " lie within " + distance +
                    " m of others on the border; \"weld\": " + distance + " joins them");
}

}  // namespace

FileLayout prepare_cloth_mesh(Cloth& cloth, const ClothMeshOptions& options,
                              std::vector<std::string>& notes) {
  FileLayout layout;
  const std::size_t count = cloth.mesh.positions.size();
  if (options.weld.distance > 0) snap(cloth, options);

  // New vertices of both sides of a seam lie at the same place as the corners do, so they are
  // welded with them.
  for (int i = 0; i < options.subdivisions; ++i) subdivide(cloth.mesh, cloth.rest);
  const WeldReport report = merge_vertices(cloth.mesh, cloth.rest, options.weld.on, layout);
  check_edges(cloth.mesh, options.file, file_numbers(layout));
  note_vertices(cloth.mesh, layout, options, count, report, notes);
  return layout;
}

std::string unit_note(const std::string& object, const std::vector<Vec3d>& positions, Vec3d scale,
                      bool is_cloth) {
  constexpr double kLargest = 10, kSmallest = 0.02;    // [m]
  constexpr double kThick = 3;                         // [m]; floors and walls are thinner
  constexpr double kLikelyLow = 0.2, kLikelyHigh = 3;  // [m]
  struct Unit {
    const char* name;
    double metres;
  };
  constexpr Unit kTooLarge[] = {{"centimetres", 0.01}, {"millimetres", 0.001}, {"inches", 0.0254}};
  constexpr Unit kTooSmall[] = {{"100 m", 100}, {"kilometres", 1000}};
  if (positions.empty()) return "";

  // The size is measured along the axes.
  const Vec3d size = box_around(positions).size();
  const double largest = std::max({size.x, size.y, size.z});
  const double smallest = std::min({size.x, size.y, size.z});
  const bool too_large = largest > kLargest && (is_cloth || smallest > kThick);
  if (!too_large && (largest >= kSmallest || largest == 0)) return "";

  // These units give it the size of a garment or of a person, the likeliest first.
  std::string units, factor, result;
  const std::span<const Unit> known = too_large ? std::span<const Unit>(kTooLarge) : kTooSmall;
  for (const Unit& unit : known) {
    if (largest * unit.metres < kLikelyLow || largest * unit.metres > kLikelyHigh) continue;
    units += (units.empty() ? "" : " or ") + std::string(unit.name);
    if (!factor.empty()) continue;
    const bool even = scale.x == scale.y && scale.y == scale.z;
    factor = rounded_text(even ? scale.x * unit.metres : unit.metres, 6);
    if (!even) factor += " times the present one";
    result = metres_text(largest * unit.metres);
  }
  const std::string line = object + " is " + metres_text(largest) + " m large";
  if (units.empty())
    return line + ": is it in metres? \"transform\": {\"scale\": …} changes its size";
  return line + ": its file is probably in " + units + "; \"transform\": {\"scale\": " + factor +
         "} makes it " + result + " m";
}

}  // namespace icloth
