// The data that change during a simulation. Every buffer: meaning [unit] (shape), written by.
#pragma once

#include "sim/scene/parameters.h"
#include "sim/state/device_memory.h"
#include "sim/state/report.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// The spring with which hands pull a vertex.
struct Spring {
  Index vertex;
  Real stiffness;  ///< [N/m]
  Vec3r target;    ///< [m]
};

/// The memory, and the buffers of one substep, which the next one does not read.
///
/// Who writes the memory during a step: x1 implicit and impact_zones, v and past finish_substep
/// (those of moving obstacles begin_substep), held and start_gap proximity, yarns match_yarns and
/// update_yarn_anchors, trusted_* broad_phase, hands use_hands. Until a substep is accepted, x1 is
/// a candidate.
struct State : Memory {
  Array<Vec3r> x0;         ///< positions at the start of the substep [m] (vertices), begin_substep
  Array<Vec3r> candidate;  ///< x*, the end without impacts [m] (cloth_vertices), implicit
  Array<Real> mass;        ///< with density_scale [kg] (cloth_vertices), set_parameters
  Array<Real> inverse_mass;  ///< 0 for pinned and obstacle vertices [1/kg] (vertices)

  /// Springs of the hands, one entry a cloth vertex; only used when has_springs.
  Array<Real> spring_stiffness;  ///< [N/m], 0: none (cloth_vertices), use_hands
  Array<Vec3r> spring_target;    ///< [m], undefined where none (cloth_vertices), use_hands
  bool has_springs = false;

  /// Deformation of x0 (cloth_faces), empty without yarn friction; update_yarn_anchors.
  Array<YarnAnchor> yarns_start;
};

/// The data that the stages of one substep share.
struct SubstepContext {
  const Topology& mesh;
  const Parameters& parameters;
  State& state;
  StepReport& report;
  Real dt;                   ///< length of the substep [s]
  double time;               ///< simulated time at the start of the substep [s]
  bool sums_up_work = true;  ///< whether the work of the forces is wanted
  double fastest = 0;        ///< largest speed of a vertex at the start of the substep [m/s]

  Real offset() const { return static_cast<Real>(parameters.impact_zones.offset); }
  Real thickness() const { return static_cast<Real>(parameters.proximity.thickness); }
  Vec3r gravity() const {
    return {static_cast<Real>(parameters.gravity.x), static_cast<Real>(parameters.gravity.y),
            static_cast<Real>(parameters.gravity.z)};
  }
};

}  // namespace icloth::ICLOTH_BUILD
