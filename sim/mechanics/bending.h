// The force of the fabric against bending, by plates or by single hinges.
#pragma once

#include "sim/mechanics/bending_terms.h"
#include "sim/mechanics/force.h"

namespace icloth::ICLOTH_BUILD {

class Bending : public Force {
 public:
  static bool couples(const Topology& mesh) { return mesh.bends; }
  /// The four vertices of each hinge.
  void lay_out(const World& world, const Topology& mesh, PatternBuilder& builder);

  void prepare(const ForceContext& c);
  HingeRows row_share(const ForceContext&) const { return {sources_.view<4>(), terms_.view()}; }

  void add_energy(const EnergyContext& c, ForceEnergy& energy) const;

 private:
  void prepare_plates(const ForceContext& c, const HingeBending& single);

  ElementSources sources_;
  Array<HingeTerm> terms_;      ///< (hinges), prepare
  Array<HingeMotion> motions_;  ///< (hinges), prepare_plates
  Array<PlateTerm> plates_;     ///< (cloth_faces), prepare_plates
};

}  // namespace icloth::ICLOTH_BUILD
