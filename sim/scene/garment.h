// A cloth that is sewn from a pattern: what is known of it beyond its mesh.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sim/pattern/sewing.h"

namespace icloth {

/// How a garment is put on before time 0 (key "dress" of a cloth).
struct DressPlan {
  bool on = true;         ///< false: the scene starts with the garment as it is sewn
  double closing = 2;     ///< longest time in which its seams draw together [s]
  double settling = 0.5;  ///< time with its whole weight after that [s]
  /// Labels of edges that are held at their height until it settles, "lower_interface" say.
  std::vector<std::string> hold;
};

/// A step from a pattern in few triangles to one in four times as many.
struct PatternDivision {
  std::shared_ptr<const MeshedPattern> coarse, fine;
  /// For each point of each panel of the fine pattern the two points of the coarse one that it lies
  /// in the middle of (panels).
  std::vector<std::vector<std::array<Index, 2>>> parents;
};

struct Garment {
  Index cloth = 0;   ///< index in scene.cloths
  std::string body;  ///< obstacle that it is worn on; empty: whatever is there
  Index layer = 0;   ///< garments of lower layers are put on first
  DressPlan plan;
  Vec3d rotation;     ///< of all panels together, axis × angle [rad]
  Vec3d translation;  ///< after the rotation [m]
  std::shared_ptr<const MeshedPattern> meshed;
  std::vector<PatternDivision> divisions;  ///< from the coarsest on; none where triangles are few
  std::vector<PanelPlacement> placements;  ///< of its panels, as they are tried last
  SewnGarment sewn;                        ///< with those; its mesh is that of the cloth
};

struct Cloth;

/// A garment of more triangles is put on in about a quarter of them, or a quarter of that, and
/// refined where it hangs.
inline constexpr Index kMostDressedTriangles = 12000;

/// Reads a pattern and meshes it with about so many triangles; its placements are the pattern's
/// own. A mesh of many triangles is a coarser one with its triangles divided. Appends a line to
/// `notes` for what users should know. Throws InputError.
Garment read_garment(const std::string& path, Index triangles, std::vector<std::string>& notes);

/// Sews the garment with its placements, and makes the result the start and the rest shape of the
/// cloth.
void sew_garment(Garment& garment, Cloth& cloth);

/// Faces within so many rings of a gathered seam are left out where strain is judged: there the
/// pattern itself asks for more cloth than the seam is long.
inline constexpr int kGatherRings = 3;

/// Marks the faces within kGatherRings of a stitch whose lengths differ by more than kGatherRatio.
std::vector<bool> gathered_faces(const Garment& garment, const Cloth& cloth);

}  // namespace icloth
