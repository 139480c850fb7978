// The scene in the memory of the device: constant during a simulation.
#pragma once

#include "kernels/plate.h"
#include "kernels/stencil.h"
#include "sim/scene/world.h"

namespace icloth::ICLOTH_BUILD {

/// Square of how far a vertex is at rest from the one in whose list it is.
struct SeamDistance {
  Index vertex;
  Real squared;  ///< [m²]
};

/// Two vertices that an open seam draws together.
struct StitchPair {
  Index a, b;
};

/// Vertices, edges and faces of cloths come before those of obstacles.
struct Topology {
  Index cloth_vertices = 0, vertices = 0;
  Index cloth_edges = 0, edges = 0;
  Index cloth_faces = 0, faces = 0;
  Index hinge_count = 0;
  Real median_edge = 0;  ///< rest length [m]

  Array<Int3> face;         ///< vertices (faces)
  Array<Int2> edge;         ///< vertices, smaller first (edges)
  Array<Vec3r> rest;        ///< rest shape in space or laid out in the pattern [m] (cloth_vertices)
  Array<Real> mass;         ///< before density_scale [kg] (cloth_vertices)
  Array<Real> vertex_area;  ///< [m²] (cloth_vertices)
  Array<Real> edge_area;    ///< [m²] (cloth_edges)
  Array<Real> face_area;    ///< rest [m²] (cloth_faces)
  Array<Index> object;      ///< object number of each vertex (vertices)
  Array<HingeRest> hinge;   ///< (hinge_count)
  Array<Fabric> fabric;     ///< one a cloth
  Array<Index> face_fabric;        ///< (cloth_faces)
  bool bends = false;              ///< whether any fabric resists bending
  bool has_yarn_friction = false;  ///< whether any fabric has it

  /// With material.bending=plate alone.
  Array<PlateRest> plate;         ///< (cloth_faces)
  Array<HingeSlots> hinge_slots;  ///< (hinge_count)
  /// The samples that Fabric::table points to; empty without material.evaluation=table.
  Array<Stiffness> stiffness_table;

  /// Distances at rest around seams (sim/scene/rest_distances.h), in squares [m²]; empty where no
  /// cloth has its rest shape in uv.
  Array<Index> rest_panel;   ///< kNone: on a seam (cloth_vertices)
  Array<Index> seam_first;   ///< (cloth_vertices + 1)
  Array<SeamDistance> seam;  ///< of each vertex those with larger numbers, sorted

  /// Own Coulomb coefficient of each object, −1: none (objects); empty where none has one.
  Array<Real> object_friction;

  /// Open seams (sim/mechanics/seam_springs.h); empty where the scene has none.
  Array<StitchPair> stitches;         ///< (pairs)
  Array<Index> seam_neighbour_first;  ///< see SeamNeighbours (cloth_vertices + 1)
  Array<Index> seam_neighbour;

  struct Inverse {
    Real m[4];
  };
  Array<Inverse> face_inverse;  ///< rows of Dm⁻¹ [1/m] (cloth_faces)

  void upload(const World& world);
};

}  // namespace icloth::ICLOTH_BUILD
