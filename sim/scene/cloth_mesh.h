// From the mesh file of a cloth to the mesh that is simulated.
#pragma once

#include <string>
#include <vector>

#include "sim/files/weld.h"
#include "sim/scene/scene.h"

namespace icloth {

/// How the vertices at one place are treated (key "weld" of a cloth).
struct WeldChoice {
  bool on = true;       ///< exact doubles become one vertex
  bool asked = false;   ///< the scene file says so
  double distance = 0;  ///< within which others are moved together first [m]
};

struct ClothMeshOptions {
  std::string object;  ///< "cloth 'shirt'", for notes
  std::string file;    ///< its mesh file, for what is refused
  WeldChoice weld;
  Vec3d scale{1, 1, 1};  ///< that the mesh is going to have, for the distance
  int subdivisions = 0;  ///< each cuts every triangle into four
};

/// Checks the mesh and the rest shape of a cloth as read, subdivides and welds them, and leaves out
/// vertices without a face. Returns how the file's vertices stand for those that are left. Appends
/// a line to `notes` for each change that users should know of. Throws InputError naming object and
/// element.
FileLayout prepare_cloth_mesh(Cloth& cloth, const ClothMeshOptions& options,
                              std::vector<std::string>& notes);

/// Returns a line when an object of that size is probably not in metres, otherwise nothing.
/// `scale` is what its transform multiplies the file with, so that the remedy can be named; bodies
/// may be larger than cloths, and flat ones of any size.
std::string unit_note(const std::string& object, const std::vector<Vec3d>& positions, Vec3d scale,
                      bool is_cloth);

}  // namespace icloth
