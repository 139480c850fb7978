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
  HingeRows row_share(const ForceContext& c) const {
    // Single hinges are linearised anew in every iteration.
    const bool plates = c.parameters.material.bending != BendingModel::hinge;
    return {sources_.view<4>(), terms_.view(),
            plates ? renewed_hinges_.view() : View<const std::uint8_t>{}};
  }

  void add_energy(const EnergyContext& c, ForceEnergy& energy) const;

 private:
  void prepare_plates(const ForceContext& c, const HingeBending& single);

  ElementSources sources_;
  Array<HingeTerm> terms_;      ///< (hinges), prepare
  Array<HingeMotion> motions_;  ///< (hinges), prepare_plates
  Array<PlateTerm> plates_;     ///< (cloth_faces), prepare_plates
  /// 1 where prepare_plates has written the term, else 0 (cloth_faces), (hinges).
  Array<std::uint8_t> renewed_plates_, renewed_hinges_;
};

}  // namespace icloth::ICLOTH_BUILD
