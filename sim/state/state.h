// What changes during a simulation. Every buffer: meaning [unit] (shape), written by.
#pragma once

#include "kernels/stencil.h"
#include "kernels/yarn_friction.h"
#include "sim/scene/parameters.h"
#include "sim/state/report.h"
#include "sim/state/topology.h"

namespace icloth::ICLOTH_BUILD {

/// What a hand does to a vertex.
struct Spring {
  Index vertex;
  Real stiffness;  ///< [N/m]
  Vec3r target;    ///< [m]
};

/// What a two-step integrator (sim/mechanics/time_rule.h) goes on from.
struct Past {
  Array<Vec3r> motion;  ///< x0 − x₋₁ [m] (cloth_vertices), finish_substep
  /// v0 − v₋₁ [m/s] (cloth_vertices), 0 where the vertex touched something; finish_substep.
  Array<Vec3r> change;
  double dt = 0;  ///< of that step [s]; 0: none, the arrays are not used

  void forget() { dt = 0; }
  void copy_from(const Past& other) {
    dt = other.dt;
    if (!(dt > 0)) return;
    motion.copy_from(other.motion);
    change.copy_from(other.change);
  }
};

struct State {
  Array<Vec3r> x0;         ///< start of the substep [m] (vertices), begin_substep
  Array<Vec3r> x1;         ///< end of the substep, a candidate until it is accepted [m] (vertices);
                           ///< implicit, impact_zones; obstacles: begin_substep
  Array<Vec3r> candidate;  ///< x*, the end without impacts [m] (cloth_vertices), implicit
  Array<Vec3r> v;          ///< velocity [m/s] (vertices), finish_substep; obstacles: begin_substep
  Array<Real> mass;        ///< with density_scale [kg] (cloth_vertices), set_parameters
  Array<Real> inverse_mass;  ///< 0 for pinned and obstacle vertices [1/kg] (vertices)

  /// Springs of the hands, one entry a cloth vertex; only used when has_springs.
  Array<Real> spring_stiffness;  ///< [N/m], 0: none (cloth_vertices), use_hands
  Array<Vec3r> spring_target;    ///< [m], undefined where none (cloth_vertices), use_hands
  bool has_springs = false;

  /// Deformation at which the friction between yarns exerts no force (cloth_faces), empty without
  /// yarn friction; match_yarns, update_yarn_anchors.
  Array<YarnAnchor> yarns;
  bool yarns_bend = false;        ///< the anchors hold curvatures beside shear; match_yarns
  Array<YarnAnchor> yarns_start;  ///< deformation of x0 (as yarns), update_yarn_anchors

  Past past;
};

/// The data that the stages of one substep share.
struct SubstepContext {
  const Topology& mesh;
  const Parameters& parameters;
  State& state;
  StepReport& report;
  Real dt;      ///< length of the substep [s]
  double time;  ///< simulated time at the start of the substep [s]

  Real offset() const { return static_cast<Real>(parameters.impact_zones.offset); }
  Real thickness() const { return static_cast<Real>(parameters.proximity.thickness); }
  Vec3r gravity() const {
    return {static_cast<Real>(parameters.gravity.x), static_cast<Real>(parameters.gravity.y),
            static_cast<Real>(parameters.gravity.z)};
  }
};

}  // namespace icloth::ICLOTH_BUILD
