// The bytes that the stages of a step have to move, and the memory that their arrays take.
//
// The model counts every array that a stage reads or writes once for each time that the stage
// passes over it, in single precision, and nothing else: no array is fetched twice because caches
// are small, no box test or elementary test reads more than its pair. It is a lower bound for
// meshes that are larger than the caches. Divided by the measured bandwidth it gives the floor of a
// stage: a stage far above it is bound by arithmetic, by scattered access or by branches, not by
// bytes. Where everything fits into a cache, a stage may be faster than its floor.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/scene/scene.h"
#include "sim/state/report.h"

namespace icloth {

/// The stages of a report in its order, the last one for what no other has measured.
enum class Stage { proximity, implicit, broad_phase, ccd, impact_zones, other };
inline constexpr std::size_t kStages = 6;
/// Their names, and the columns of a report that have their times.
inline constexpr std::array<const char*, kStages> kStageNames = {
    "proximity", "implicit", "broad_phase", "ccd", "impact_zones", "other"};
inline constexpr std::array<double StepReport::*, kStages> kStageTimes = {
    &StepReport::ms_proximity, &StepReport::ms_implicit,     &StepReport::ms_broad_phase,
    &StepReport::ms_ccd,       &StepReport::ms_impact_zones, &StepReport::ms_other};

/// The elements of a scene.
struct MeshCounts {
  double cloth_vertices = 0, cloth_faces = 0, cloth_edges = 0;
  double hinges = 0;                          ///< edges of cloths with a face on either side
  double vertices = 0, faces = 0, edges = 0;  ///< of bodies too
};
MeshCounts count_elements(const Scene& scene);

/// Bytes of an entry of the arrays, in single precision.
namespace array_entry {
inline constexpr double kPosition = 12, kIndex = 4, kPair = 8, kBox = 24;
inline constexpr double kBlock = 36;        ///< of the matrix
inline constexpr double kFaceRest = 36;     ///< indices, inverse of the rest shape, area, fabric
inline constexpr double kFaceTerm = 252;    ///< share of a face in the system
inline constexpr double kHingeRest = 44;    ///< of a hinge: indices and rest shape
inline constexpr double kHingeTerm = 56;    ///< its share of the system
inline constexpr double kContact = 88;      ///< a pair in proximity
inline constexpr double kContactTerm = 52;  ///< its share of the system
inline constexpr double kConstraint = 136;  ///< of an impact zone: kept, and ordered by zone
}  // namespace array_entry

/// A number for each stage.
using PerStage = std::array<double, kStages>;

/// The bytes that a step had to move at least.
PerStage least_bytes(const MeshCounts& mesh, const StepReport& report);

/// The bytes of the largest arrays of each stage, as full as they are.
PerStage array_bytes(const MeshCounts& mesh, const StepReport& report);

/// The model in words, a line each stage.
std::vector<std::string> model_text();

}  // namespace icloth
