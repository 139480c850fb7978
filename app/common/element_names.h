// Names of faces and vertices in the user's terms: the object, and the number within it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/files/weld.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene.h"
#include "sim/state/report.h"

namespace icloth {

/// Numbers elements across objects in scene order, cloths first, and names them again.
class ElementNames {
 public:
  /// `layouts` are those of the cloths' files: their vertices are named by the numbers that they
  /// have there. Empty: by those of the mesh.
  explicit ElementNames(const Scene& scene, std::span<const FileLayout> layouts = {});
  /// Adds an object with its name ("cloth:shirt"), vertices and faces.
  void add(std::string name, Index vertices, Index faces);

  std::string face(Index global) const;                   ///< "cloth:NAME face 12"
  std::string vertex(Index global) const;                 ///< "cloth:NAME vertex 7"
  std::string pair(const IntersectingFaces& pair) const;  ///< "… face a — … face b"
  std::string touch(const Touch& touch) const;            ///< "vertex … 8 lies on edge … 2 3"
  std::string pair(const OffendingPair& pair) const;      ///< "… vertex 1 — face of … 2 3 4"

 private:
  struct Object {
    std::string name;
    Index first_vertex, first_face;
    std::vector<Index> file_numbers;  ///< of the vertices, where they are not those of the mesh
  };
  static std::string number(const Object& object, Index vertex);
  const Object& at_face(Index global) const;
  const Object& at_vertex(Index global) const;
  std::string vertices(std::span<const Index> globals) const;

  std::vector<Object> objects_;
  Index vertices_ = 0, faces_ = 0;
};

/// "obstacle:ball is pushed into the pinned vertices 3 4 of cloth:shirt", where a refused step left
/// collisions of bodies at pinned vertices or beside them; empty where it did not.
std::string pins_in_the_way(const Scene& scene, const ElementNames& names,
                            const StepReport& report);
/// The faces that hold all vertices of one of the two elements of a pair, sorted.
std::vector<Index> faces_of_pairs(std::span<const Triangle> faces,
                                  std::span<const OffendingPair> pairs);

/// What a user can do about the conflicts of a start state, a sentence each, where that is known.
std::vector<std::string> start_remedies(const Scene& scene, const StartConflicts& conflicts,
                                        bool single_precision);

/// Says that surfaces are too close for the builds in single precision, and what helps.
inline constexpr const char* kTooCloseForSingle =
    "They are apart in the scene, but closer than single precision resolves: move them apart, or "
    "use --precision f64.";

/// Prints what intersects or touches in the start state of a scene to stderr, the first ten by
/// name. 0: nothing. Otherwise nothing may be simulated, and the number is an exit code: 1 where
/// faces intersect, 2 where only neighbouring faces touch, which is the fault of a mesh.
int report_start_intersections(const Scene& scene, bool single_precision,
                               std::span<const FileLayout> layouts = {});

}  // namespace icloth
