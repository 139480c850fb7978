// Tests of a garment's start: which faces intersect when its panels stand here or there.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/scene/intersections.h"
#include "sim/scene/scene.h"

namespace icloth {

/// What a garment may go through at its start, as a scene that does not move: the bodies at time 0,
/// contracted so far [m] by contract(), and the garments `on`, pinned, numbers in scene.garments.
Scene still_scene(const Scene& scene, std::span<const std::size_t> on, double contraction);

/// The faces of such a scene.
class FixedFaces {
 public:
  explicit FixedFaces(const Scene& still);

  const FaceTree& tree() const { return tree_; }
  /// "body 'woman'" or "cloth 'tee'": whose the face is.
  const std::string& name_of(std::size_t face) const;

 private:
  struct Soup {
    std::vector<Vec3d> positions;
    std::vector<Triangle> faces;
    std::vector<std::string> names;
    std::vector<std::size_t> first_face;  ///< of each name
  };
  explicit FixedFaces(Soup soup);

  FaceTree tree_;
  std::vector<std::string> names_;
  std::vector<std::size_t> first_face_;
};

/// One garment, whose panels are put to places that are tried.
class StartTrial {
 public:
  /// Keeps a reference to `around`.
  StartTrial(const Scene& scene, std::size_t garment, const FixedFaces& around);

  /// Pairs of faces that intersect where one of them is the garment's, with these placements.
  std::vector<IntersectingFaces> pairs(const std::vector<PanelPlacement>& placements);

  /// How many of them are pairs of two faces of the garment.
  std::size_t own_pairs(const std::vector<PanelPlacement>& placements);

  /// How many pairs each panel takes part in.
  std::vector<std::size_t> by_panel(std::span<const IntersectingFaces> pairs) const;

  /// The pairs in words, "panel 'back' and body 'woman' (12 pairs of faces)", the most frequent
  /// first.
  std::vector<std::string> clauses(std::span<const IntersectingFaces> pairs) const;

  /// How often pairs() was called.
  int checks() const { return checks_; }

 private:
  void place(const std::vector<PanelPlacement>& placements);
  std::string name_of(Index face) const;

  Garment garment_;
  Cloth cloth_;
  const FixedFaces& around_;
  int checks_ = 0;
};

}  // namespace icloth
