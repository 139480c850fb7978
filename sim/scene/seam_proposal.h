// Seams that borders of a delivered garment suggest, whose panels lie beside each other unsewn.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/seam.h"

namespace icloth {

/// Pairs in a row along two borders, or along two stretches of one.
struct ProposedSeam {
  std::vector<std::array<Index, 2>> pairs;  ///< vertices of the mesh, in the order of the borders
  std::array<Index, 2> panel{};             ///< numbers of the panels of its sides
  double mean_gap = 0, largest_gap = 0;     ///< of its pairs [m]
  /// Mean angle between the two surfaces [rad]: π where one continues the other, 0 where they lie
  /// upon each other.
  double angle = 0;
  std::size_t unpaired = 0;  ///< vertices of the borders between its pairs, where holes stay
};

struct SeamProposal {
  std::vector<Index> panel;  ///< of each face: faces that share vertices are one panel (F)
  std::size_t panels = 0;
  std::vector<ProposedSeam> seams;
  std::size_t border_vertices = 0;
  std::size_t sewn_vertices = 0;  ///< of them, those in a pair
  std::size_t scattered = 0;      ///< pairs that were left out, since too few stand in a row
  /// Pairs that were left out, since a face would lose a corner.
  std::size_t crossing = 0;
};

/// Proposes the seams of a mesh of panels: vertices of two borders that are each the nearest on the
/// other border, at most `within` [m] apart, where at least three such pairs go on in a row along
/// both borders in one direction. Vertices of one border are paired where the way between them
/// along it is longer than three times `within`. Throws InputError where so many vertices lie
/// within reach of each other that the search would not end soon.
SeamProposal propose_seams(const TriangleMesh& mesh, double within);

/// The pairs of all seams as one seam of cloth 0, for weld_seam.
Seam joint_seam(const SeamProposal& proposal);

}  // namespace icloth
